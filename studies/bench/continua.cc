#include "studies/bench/continua.h"

#include <fmt/format.h>

#include "meshes/tables/fields_json.h"
#include "studies/files/json_entry.h"
#include "studies/fits/setup/fit_curves.h"
#include "studies/presses/pace.h"
#include "studies/presses/press_setup.h"
#include "studies/presses/reference_job.h"

namespace fingertip::studies::inline bench {

namespace {

std::vector<double> even(double from, double to, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(from + (to - from) * i / (count - 1));
  return values;
}

fem_reference::ReferenceJob setup_for(const LoadedConfig& loaded, bool finite,
                                      const std::vector<double>& depths, int degree,
                                      double refinement) {
  return continuum_setup(
      with_sets(loaded, {"press.contact=stick", samples_setting(depths),
                         fmt::format("reference.strain={}", finite ? "finite" : "linear"),
                         fmt::format("reference.degree={}", degree),
                         fmt::format("reference.refinement={:.9g}", refinement)}));
}

}  // namespace

std::vector<double> error_depths(const BenchPlan& plan, int count) {
  std::vector<double> depths = even(plan.error_from, plan.depth, count);
  depths.insert(depths.begin(), 0.5 * plan.error_from);
  return depths;
}

// Between nine depths an interpolation would be off by 0.4 %: at 41 the samples of presses in time
// lie, so nothing is interpolated.
Job truth_job(const LoadedConfig& loaded, const BenchPlan& plan, bool finite) {
  fem_reference::ReferenceJob reference = setup_for(
      loaded, finite, error_depths(plan, 41), plan.reference_degree, plan.reference_refinement);
  reference.tolerance = plan.reference_tolerance;
  reference.estimate_error = plan.reference_error;
  return reference_job(reference);
}

Job continuum_job(const LoadedConfig& loaded, const BenchPlan& plan,
                  const ContinuumMesh& continuum) {
  const int solves = plan.continuum_solves;
  fem_reference::ReferenceJob reference =
      setup_for(loaded, true, even(plan.depth / solves, plan.depth, solves), continuum.degree,
                continuum.refinement);
  reference.estimate_error = reference.write_fields = false;
  Job job = reference_job(reference);
  job.repeatable = false;
  return job;
}

nlohmann::ordered_json continuum_entry(const std::filesystem::path& folder,
                                       const ContinuumMesh& continuum,
                                       const meshes::PressResponse& truth, const BenchPlan& plan,
                                       double period) {
  const auto summary = parse_json(folder / "summary.json");
  double seconds = 0.0;
  for (const auto& sample : summary.at("samples")) seconds += sample.at("wall_time").get<double>();
  const double rate = double(summary.at("samples").size()) / seconds;
  const auto response = meshes::PressResponse::read_csv(folder / "response.csv");
  return {{"degree", continuum.degree},
          {"refinement", continuum.refinement},
          {"unknowns", summary.at("dofs")},
          {"solves_per_second", rate},
          {"real_time_factor", rate * period},
          {"worst_force_error",
           meshes::json_of(worst_force_error(response, truth, plan.error_from, plan.depth))}};
}

std::string continuum_name(const ContinuumMesh& continuum) {
  return fmt::format("degree{}_{:.3g}", continuum.degree, continuum.refinement);
}

}  // namespace fingertip::studies::inline bench
