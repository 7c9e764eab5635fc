#include "studies/fits/runs/surrogate_job.h"

#include <cmath>
#include <functional>

#include "calibration/press_fit/lattice_forward_model.h"
#include "calibration/surrogate/surrogate.h"
#include "meshes/tables/fields_json.h"
#include "source_hash.h"
#include "studies/fits/models/travel.h"
#include "studies/presses/press_record.h"

namespace fingertip::studies::inline fits::inline runs {

namespace {

namespace fs = std::filesystem;
using calibration::LatticeForwardModel;
using calibration::MaterialParameter;
using calibration::SurrogateSample;
using nlohmann::ordered_json;

constexpr std::size_t sample_count = 32;

/// Of the press with the parameters as they stand in `setup`; without parameters the force alone.
calibration::CurveSlopes answer(const lattice::PressSetup& setup,
                                const ForceUncertainty& uncertainty,
                                const std::function<bool()>& go_on) {
  std::vector<MaterialParameter> parameters = uncertainty.parameters;
  if (parameters.empty()) parameters = {MaterialParameter::contact};
  Eigen::VectorXd values(Eigen::Index(parameters.size()));
  for (std::size_t i = 0; i < parameters.size(); ++i)
    values(Eigen::Index(i)) = calibration::value_of(parameters[i], setup);
  return LatticeForwardModel(setup, parameters, go_on).evaluate(values);
}

std::vector<SurrogateSample> samples_of(const lattice::PressSetup& setup,
                                        const ForceUncertainty& uncertainty,
                                        const calibration::CurveSlopes& press) {
  std::vector<SurrogateSample> samples;
  for (Eigen::Index i = 0; i < press.value.size(); ++i) {
    double variance = std::pow(uncertainty.model_error * press.value(i), 2);
    if (!uncertainty.parameters.empty())
      variance +=
          press.jacobian.row(i) * uncertainty.covariance * press.jacobian.row(i).transpose();
    samples.push_back({setup.protocol.samples[std::size_t(i)], press.value(i),
                       std::sqrt(std::max(variance, 0.0))});
  }
  return samples;
}

void run_surrogate(const lattice::PressSetup& setup, const ForceUncertainty& uncertainty,
                   const fs::path& folder, const JobContext& context) {
  const auto go_on = [&] { return context.report(0.5, "pressing"); };
  const calibration::Surrogate surrogate =
      calibration::fit_surrogate(samples_of(setup, uncertainty, answer(setup, uncertainty, go_on)),
                                 std::string(meshes::name(setup.protocol.contact)));
  calibration::write_surrogate_csv(surrogate, folder / "surrogate.csv");
  calibration::write_surrogate_json(surrogate, folder / "surrogate.json");
  meshes::write_json_file({{"status", "finished"}, {"statement", surrogate.table().statement}},
                          folder / "summary.json");
}

}  // namespace

Job surrogate_job(const lattice::PressSetup& press, const ForceUncertainty& uncertainty) {
  lattice::PressSetup setup = press;
  setup.protocol.samples = meshes::even_depths(press.protocol.depth, sample_count);
  std::vector<std::string> names;
  for (const MaterialParameter parameter : uncertainty.parameters)
    names.emplace_back(calibration::name(parameter));
  return {.kind = "surrogate",
          .inputs = {{"format", 1},
                     {"press", inputs_of(setup)},
                     {"parameters", names},
                     {"covariance", meshes::json_of(uncertainty.covariance)},
                     {"model_error", uncertainty.model_error}},
          .source_hash = source_hash::calibration,
          .run = std::bind_front(run_surrogate, setup, uncertainty),
          .weight = surrogate_weight};
}

}  // namespace fingertip::studies::inline fits::inline runs
