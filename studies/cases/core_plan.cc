/// The core case: fits, cubes, the continuum and a press of every model under the controller.

#include <algorithm>
#include <cmath>

#include "fem_reference/verification/verification_file.h"
#include "meshes/press_response.h"
#include "meshes/table_rows.h"
#include "studies/cases/equilibrium_study.h"
#include "studies/cases/folders.h"
#include "studies/cases/force_errors.h"
#include "studies/cases/measures.h"
#include "studies/cases/plan.h"
#include "studies/cases/published_study.h"
#include "studies/files/case_summary.h"
#include "studies/files/json_fields.h"
#include "studies/files/press_summary.h"
#include "studies/files/run_tables.h"
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
  ModelEntry model_entry(const fs::path& press, const std::string& status) const;

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
  const auto checks = struct_of<fem_reference::VerificationFile>(
                          read_entry(folder / "verification" / "verification.json"))
                          .checks;
  const auto failed = std::ranges::count(checks, false, &fem_reference::Check::passed);
  return {{"checks", checks.size()}, {"failed_checks", failed}};
}

ModelEntry CorePlan::model_entry(const fs::path& press, const std::string& status) const {
  ModelEntry entry;
  if (fs::exists(press / "summary.json")) {
    const auto summary = struct_of<PressSummary>(read_entry(press / "summary.json"));
    const ModuliEntry& moduli = summary.moduli;
    entry.E_100 = moduli.E_100;
    entry.E_110 = moduli.E_110;
    entry.E_111 = moduli.E_111;
    entry.G = moduli.G;
    entry.nu_100 = moduli.nu_100;
    entry.K = moduli.K;
    entry.anisotropy = moduli.anisotropy;
    entry.real_time_factor = summary.real_time_factor;
  }
  const PressResponse response = response_in(press);
  for (const auto& error : force_errors(response, reference_, config().press.protocol.depth))
    entry.force_error.push_back(number_of(error));
  const double reached = std::min(response.depth(), reference_.depth());
  if (reached > 0.0)
    entry.relative_l2_force_error = relative_l2_force_error(response, reference_, 0.0, reached);
  entry.status = status == finished ? "ok" : status;
  return entry;
}

/// Largest relative deviation of the hookean cubes in cubes.csv from the rubber's E, G, nu.
double cube_error(const fs::path& folder, const meshes::Rubber& rubber) {
  const std::pair<double CubeRow::*, double> wanted[] = {
      {&CubeRow::youngs_modulus_100, rubber.youngs_modulus},
      {&CubeRow::youngs_modulus_110, rubber.youngs_modulus},
      {&CubeRow::youngs_modulus_111, rubber.youngs_modulus},
      {&CubeRow::shear_modulus, rubber.shear_modulus},
      {&CubeRow::poissons_ratio_100, rubber.poissons_ratio()}};
  double worst = std::nan("");
  for (const CubeRow& cube : meshes::read_rows<CubeRow>(folder / "cubes.csv")) {
    if (cube.model != "hookean") continue;
    for (const auto& [value, target] : wanted) {
      const double error = std::abs(cube.*value - target) / std::max(std::abs(target), 1e-3);
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
    summary["models"][model] = meshes::json_of(model_entry(folder / model, result->status));
  }
  return summary;
}

}  // namespace

std::unique_ptr<Plan> core_plan(const Case& one) {
  return std::make_unique<CorePlan>(one);
}

}  // namespace fingertip::studies
