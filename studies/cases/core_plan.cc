/// The core case: fits, cubes, the continuum and a press of every model under the controller.

#include <algorithm>
#include <cmath>

#include "meshes/csv_table.h"
#include "meshes/files.h"
#include "meshes/press_response.h"
#include "studies/cases/equilibrium_study.h"
#include "studies/cases/force_errors.h"
#include "studies/cases/measures.h"
#include "studies/cases/plan.h"
#include "studies/cases/published_study.h"
#include "studies/files/json_entry.h"
#include "studies/run/jobs.h"
#include "studies/run/json_file.h"
#include "studies/run/press_setup.h"

namespace fingertip::studies {

namespace {

using meshes::PressResponse;
using nlohmann::ordered_json;
namespace fs = std::filesystem;

class CorePlan : public Plan {
 public:
  explicit CorePlan(const Case& one) : case_(one) {}

  std::vector<PlannedJob> jobs() override;
  ordered_json conclude(const fs::path& folder, const std::vector<JobResult>& results) override;
  std::map<std::string, double> measures(const fs::path& folder,
                                         const ordered_json& summary) const override;

 private:
  ordered_json reference_entry() const;
  ordered_json model_entry(const fs::path& press, const std::string& status) const;

  const Config& config() const { return case_.loaded.config; }

  const Case& case_;
  PublishedStudy study_;
  EquilibriumStudy equilibrium_;
  PressResponse reference_;
};

std::vector<PlannedJob> CorePlan::jobs() {
  const meshes::Rubber& rubber = config().press.rubber;
  std::vector<PlannedJob> jobs;
  // The longest first, so that the lanes end together.
  jobs.push_back({"reference", reference_job(continuum_job(case_.loaded)), false});
  jobs.push_back({"verification", verification_job(), false});
  std::map<std::string, lattice::PressSetup> setups;
  for (const std::string& model : validated_models()) {
    setups[model] =
        press_setup(case_.loaded.with({"lattice.model=" + model, "lattice.constants=auto"}));
    jobs.push_back({model, press_job(setups[model]), model != "hookean"});
  }
  study_ = PublishedStudy(setups["published"]);
  equilibrium_ = EquilibriumStudy(setups["hookean"], setups["central"]);
  for (PlannedJob& job : equilibrium_.jobs()) jobs.push_back(std::move(job));
  for (PlannedJob& job : study_.jobs()) jobs.push_back(std::move(job));
  for (const auto kind : {lattice::ModelKind::central, lattice::ModelKind::hookean}) {
    jobs.push_back({"calibration_" + std::string(lattice::name(kind)),
                    moduli_job(rubber, fit_options(case_.loaded, kind)), false});
  }
  jobs.push_back({"cubes",
                  cubes_job(rubber, setups["central"].lattice.constants,
                            setups["hookean"].lattice.constants, config().press.lattice.spacing),
                  false});
  return jobs;
}

ordered_json CorePlan::reference_entry() const {
  ordered_json force = ordered_json::array();
  ordered_json error = ordered_json::array();
  for (const double depth : verdict_depths(config().press.protocol.depth)) {
    const double value = reference_.normal_force_at(depth);
    force.push_back(value);
    error.push_back(number_or_null(estimated_force_error(reference_, depth)));
  }
  return {{"status", finished}, {"force", force}, {"relative_force_error", error}};
}

ordered_json verification_entry(const fs::path& folder) {
  const JsonList checks =
      array_at(read_entry(folder / "verification" / "verification.json"), "checks");
  const auto failed = std::ranges::count_if(
      checks, [](const JsonEntry& check) { return !check.at("passed").flag(); });
  return {{"checks", checks.size()}, {"failed_checks", failed}};
}

ordered_json CorePlan::model_entry(const fs::path& press, const std::string& status) const {
  ordered_json entry;
  if (fs::exists(press / "summary.json")) {
    const ordered_json summary = read_json(press / "summary.json");
    entry = summary["moduli"];
    entry["real_time_factor"] = summary["real_time_factor"];
  }
  PressResponse response;
  if (fs::exists(press / "response.csv"))
    response = PressResponse::read_csv(press / "response.csv");
  entry["force_error"] = force_errors(response, reference_, config().press.protocol.depth);
  const double reached = std::min(response.depth(), reference_.depth());
  entry["relative_l2_force_error"] =
      reached > 0.0 ? number_or_null(relative_l2_force_error(response, reference_, 0.0, reached))
                    : ordered_json();
  entry["status"] = status == finished ? "ok" : status;
  return entry;
}

/// Largest relative deviation of the hookean cubes in cubes.csv from the rubber's E, G, nu.
double cube_error(const fs::path& folder, const meshes::Rubber& rubber) {
  const std::pair<const char*, double> wanted[] = {
      {"youngs_modulus_100 [Pa]", rubber.youngs_modulus},
      {"youngs_modulus_110 [Pa]", rubber.youngs_modulus},
      {"youngs_modulus_111 [Pa]", rubber.youngs_modulus},
      {"shear_modulus [Pa]", rubber.shear_modulus},
      {"poissons_ratio_100", rubber.poissons_ratio()}};
  const meshes::CsvTable cubes = meshes::read_csv(folder / "cubes.csv");
  const std::vector<std::string> models = cubes.texts("model");
  double worst = std::nan("");
  for (const auto& [column, target] : wanted) {
    const std::vector<double> values = cubes.numbers(column);
    for (std::size_t row = 0; row < values.size(); ++row) {
      if (models[row] != "hookean") continue;
      const double error = std::abs(values[row] - target) / std::max(std::abs(target), 1e-3);
      if (std::isnan(error)) return error;
      worst = std::isnan(worst) ? error : std::max(worst, error);
    }
  }
  return worst;
}

std::map<std::string, double> CorePlan::measures(const fs::path& folder,
                                                 const ordered_json& summary) const {
  std::map<std::string, ordered_json> press;
  for (const std::string& model : validated_models()) {
    const fs::path file = folder / model / "summary.json";
    press[model] = fs::exists(file) ? read_json(file) : ordered_json::object();
  }
  return take_measures(summary, press, cube_error(folder, config().press.rubber));
}

ordered_json CorePlan::conclude(const fs::path& folder, const std::vector<JobResult>& results) {
  fs::copy_file(folder / "cubes" / "cubes.csv", folder / "cubes.csv",
                fs::copy_options::overwrite_existing);
  reference_ = PressResponse::read_csv(folder / "reference" / "response.csv");
  study_.write_table(folder, reference_);
  equilibrium_.write_table(folder, reference_);

  const meshes::Rubber& rubber = config().press.rubber;
  ordered_json summary = {
      {"target",
       {{"youngs_modulus", rubber.youngs_modulus},
        {"shear_modulus", rubber.shear_modulus},
        {"poissons_ratio", rubber.poissons_ratio()},
        {"bulk_modulus", rubber.bulk_modulus()}}},
      {"depths", verdict_depths(config().press.protocol.depth)},
      {"reference", reference_entry()},
      {"verification", verification_entry(folder)},
      {"equilibrium", {{"hookean_force_error", equilibrium_.hookean_errors(folder, reference_)}}}};
  for (const std::string& model : validated_models()) {
    const auto result = std::ranges::find(results, model, &JobResult::name);
    summary["models"][model] = model_entry(folder / model, result->status);
  }
  return summary;
}

}  // namespace

std::unique_ptr<Plan> core_plan(const Case& one) {
  return std::make_unique<CorePlan>(one);
}

}  // namespace fingertip::studies
