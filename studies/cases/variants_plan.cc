/// A study: static presses that differ in a few keys, each beside the continuum of its own
/// specimen.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "meshes/table_rows.h"
#include "studies/cases/folders.h"
#include "studies/cases/force_errors.h"
#include "studies/cases/plan.h"
#include "studies/cases/variant_measures.h"
#include "studies/files/case_summary.h"
#include "studies/files/json_fields.h"
#include "studies/files/press_summary.h"
#include "studies/files/run_tables.h"
#include "studies/report/run_data.h"
#include "studies/run/fit_setup.h"
#include "studies/run/jobs.h"
#include "studies/run/json_file.h"
#include "studies/run/press_setup.h"

namespace fingertip::studies {

namespace {

using meshes::PressResponse;
using nlohmann::ordered_json;
using reporting::force_at;
namespace fs = std::filesystem;

/// A variant ready to run. Variants that come to the same press share its folder.
struct Press {
  lattice::PressSetup setup;
  std::string folder;
  std::size_t continuum = 0;
};

/// What presses are measured against: lattice, offset and rotation do not matter to it.
struct Continuum {
  fem_reference::ReferenceJob order;
  std::string key;  ///< of its job
  std::string folder;
};

class VariantsPlan : public Plan {
 public:
  explicit VariantsPlan(const Case& one) : case_(one) {}

  std::vector<PlannedJob> jobs() override;
  ordered_json conclude(const fs::path& folder, const std::vector<JobResult>& results) override;
  std::map<std::string, double> measures(const fs::path& folder,
                                         const ordered_json& summary) const override;

 private:
  void add(const CaseVariant& variant, std::vector<PlannedJob>& presses);
  std::size_t continuum_of(const LoadedConfig& loaded, const lattice::PressSetup& setup);
  std::string free_folder(const CaseVariant& variant);
  VariantResult result_of(const Press& press, const fs::path& folder) const;
  std::vector<VariantRow> rows_of(std::size_t place, const fs::path& folder,
                                  const std::string& status) const;
  std::vector<SeriesEntry> series_entries() const;
  std::vector<ContinuumEntry> continuum_entries() const;
  std::vector<BudgetEntry> budget_entries() const;

  const Case& case_;
  std::vector<Press> presses_;  ///< in the order of the case's variants
  std::vector<Continuum> continua_;
  std::map<std::string, std::string> folder_of_key_;
  std::set<std::string> folders_;
  VariantResults results_;
  std::size_t not_converged_ = 0;
};

std::string VariantsPlan::free_folder(const CaseVariant& variant) {
  const std::string series = variant.series.empty() ? "" : as_folder(variant.series) + "/";
  std::string folder = "variants/" + series + as_folder(variant.name);
  while (!folders_.insert(folder).second) folder += "_";
  return folder;
}

/// At finite strain law A, which the network stands for.
std::size_t VariantsPlan::continuum_of(const LoadedConfig& loaded,
                                       const lattice::PressSetup& setup) {
  const fem_reference::ReferenceJob checked = continuum_beside(loaded, setup.lattice.kinematics);
  const std::string key = reference_job(checked).key();
  const auto found = std::ranges::find(continua_, key, &Continuum::key);
  if (found == continua_.end())
    continua_.push_back({checked, key, fmt::format("continuum/{}", continua_.size() + 1)});
  return std::size_t(std::ranges::find(continua_, key, &Continuum::key) - continua_.begin());
}

void VariantsPlan::add(const CaseVariant& variant, std::vector<PlannedJob>& presses) {
  const LoadedConfig loaded = variant_config(case_, variant);
  Press press;
  try {
    press.setup = press_setup(loaded);
    press.continuum = continuum_of(loaded, press.setup);
  } catch (const ConfigError& error) {
    throw at_variant(error, variant);
  }
  const Job job = press_job(press.setup);
  std::string& folder = folder_of_key_[job.key()];
  if (folder.empty()) {
    folder = free_folder(variant);
    presses.push_back({folder, job, true});
  }
  press.folder = folder;
  presses_.push_back(std::move(press));
}

std::vector<PlannedJob> VariantsPlan::jobs() {
  std::vector<PlannedJob> presses;
  std::vector<Problem> problems;
  for (const CaseVariant& variant : case_.variants) {
    try {
      add(variant, presses);
    } catch (const ConfigError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw ConfigError(problems);
  // The longest first, so that the lanes end together.
  std::vector<PlannedJob> jobs;
  for (const Continuum& continuum : continua_)
    jobs.push_back({continuum.folder, reference_job(continuum.order), false});
  std::ranges::stable_sort(presses, std::greater(),
                           [](const PlannedJob& one) { return one.job.weight; });
  jobs.insert(jobs.end(), presses.begin(), presses.end());
  return jobs;
}

VariantResult VariantsPlan::result_of(const Press& press, const fs::path& folder) const {
  const PressResponse response = response_in(folder / press.folder);
  const PressResponse continuum = response_in(folder / continua_[press.continuum].folder);
  VariantResult result;
  result.spacing = press.setup.lattice.spacing;
  for (const double depth : press.setup.protocol.samples) {
    const double force = force_at(response, depth), wanted = force_at(continuum, depth);
    result.depth.push_back(depth);
    result.force.push_back(force);
    result.reference_force.push_back(wanted);
    result.reference_error.push_back(estimated_force_error(continuum, depth));
    result.error.push_back(force / wanted - 1.0);
  }
  return result;
}

std::vector<VariantRow> VariantsPlan::rows_of(std::size_t place, const fs::path& folder,
                                              const std::string& status) const {
  const CaseVariant& variant = case_.variants[place];
  const Press& press = presses_[place];
  const VariantResult& result = results_[place];
  const fs::path file = folder / press.folder / "summary.json";
  PressSummary summary;
  if (fs::exists(file)) summary = struct_of<PressSummary>(read_entry(file));
  VariantRow row;
  row.series = variant.series;
  row.name = variant.name;
  row.x = variant.x;
  row.model = lattice::name(press.setup.lattice.model);
  row.kinematics = lattice::name(press.setup.lattice.kinematics);
  row.contact = meshes::name(press.setup.protocol.contact);
  row.poissons_ratio = press.setup.rubber.poissons_ratio();
  row.spacing = result.spacing;
  row.continuum = continua_[press.continuum].folder;
  row.volume_defect = summary.static_census.volume / summary.static_census.exact_volume - 1.0;
  row.wall_time = summary.wall_time;
  row.status = status;
  std::vector<VariantRow> rows;
  for (std::size_t d = 0; d < result.depth.size(); ++d) {
    row.indentation = result.depth[d];
    row.normal_force = result.force[d];
    row.reference_force = result.reference_force[d];
    row.reference_error = result.reference_error[d];
    row.relative_error = result.error[d];
    rows.push_back(row);
  }
  return rows;
}

std::vector<SeriesEntry> VariantsPlan::series_entries() const {
  std::vector<SeriesEntry> list;
  for (const std::string& name : series_names(case_)) {
    const SeriesMeasures measures = measure_series(case_, name, results_);
    list.push_back(
        {name, measures.worst_error, measures.finest_error, measures.spread, measures.order});
  }
  return list;
}

std::vector<ContinuumEntry> VariantsPlan::continuum_entries() const {
  std::vector<ContinuumEntry> list;
  for (const Continuum& continuum : continua_) {
    const meshes::Rubber& rubber = continuum.order.rubber;
    list.push_back({continuum.folder, std::string(fem_reference::name(continuum.order.strain)),
                    std::string(meshes::name(continuum.order.contact)), rubber.youngs_modulus,
                    rubber.shear_modulus, rubber.poissons_ratio()});
  }
  return list;
}

std::vector<BudgetEntry> VariantsPlan::budget_entries() const {
  std::vector<BudgetEntry> list;
  for (const CaseBudget& budget : case_.budgets) {
    const Budget taken = take_budget(case_, budget, results_);
    BudgetEntry entry{budget.name, taken.depth, taken.total, {}, taken.rest};
    for (std::size_t i = 0; i < budget.parts.size(); ++i)
      entry.parts.push_back({budget.parts[i], taken.parts[i]});
    list.push_back(std::move(entry));
  }
  return list;
}

ordered_json VariantsPlan::conclude(const fs::path& folder, const std::vector<JobResult>& results) {
  std::vector<VariantRow> rows;
  for (std::size_t i = 0; i < presses_.size(); ++i) {
    results_.push_back(result_of(presses_[i], folder));
    const auto job = std::ranges::find(results, presses_[i].folder, &JobResult::name);
    if (!job->ok()) ++not_converged_;
    for (VariantRow& row : rows_of(i, folder, job->status)) rows.push_back(std::move(row));
  }
  meshes::write_rows(rows, folder / "variants.csv");
  const StudyEntry study{case_.abscissa,   presses_.size(),     not_converged_,
                         series_entries(), continuum_entries(), budget_entries()};
  return {{"variants", meshes::json_of(study)}};
}

std::map<std::string, double> VariantsPlan::measures(const fs::path&, const ordered_json&) const {
  return take_variant_measures(case_, results_, not_converged_);
}

}  // namespace

std::unique_ptr<Plan> variants_plan(const Case& one) {
  return std::make_unique<VariantsPlan>(one);
}

}  // namespace fingertip::studies
