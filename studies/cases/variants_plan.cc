/// A study: static presses that differ in a few keys, each beside the continuum of its own
/// specimen.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <set>

#include "meshes/files.h"
#include "studies/cases/folders.h"
#include "studies/cases/force_errors.h"
#include "studies/cases/plan.h"
#include "studies/cases/variant_measures.h"
#include "studies/report/figure.h"
#include "studies/report/run_data.h"
#include "studies/run/fit_setup.h"
#include "studies/run/jobs.h"
#include "studies/run/json_file.h"
#include "studies/run/press_setup.h"

namespace fingertip::studies {

namespace {

using meshes::PressResponse;
using nlohmann::ordered_json;
using reporting::csv_cell;
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
  std::string rows_of(std::size_t place, const fs::path& folder, const std::string& status) const;
  ordered_json series_entries() const;
  ordered_json continuum_entries() const;
  ordered_json budget_entries() const;

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

constexpr const char* table_head =
    "series,name,x,model,kinematics,contact,poissons_ratio,spacing [m],continuum,indentation [m],"
    "normal_force [N],reference_force [N],reference_error,relative_error,volume_defect,"
    "wall_time [s],status\n";

std::string VariantsPlan::rows_of(std::size_t place, const fs::path& folder,
                                  const std::string& status) const {
  const CaseVariant& variant = case_.variants[place];
  const Press& press = presses_[place];
  const VariantResult& result = results_[place];
  const fs::path file = folder / press.folder / "summary.json";
  const JsonEntry summary = fs::exists(file) ? read_entry(file) : JsonEntry();
  const JsonEntry census = object_at(summary, "census");
  const double defect = number_at(census, "volume") / number_at(census, "exact_volume") - 1.0;
  const std::string head = fmt::format(
      "{},{},{},{},{},{},{},{},{}", csv_cell(variant.series), csv_cell(variant.name),
      meshes::to_text(variant.x), lattice::name(press.setup.lattice.model),
      lattice::name(press.setup.lattice.kinematics), meshes::name(press.setup.protocol.contact),
      meshes::to_text(press.setup.rubber.poissons_ratio()), meshes::to_text(result.spacing),
      continua_[press.continuum].folder);
  std::string rows;
  for (std::size_t d = 0; d < result.depth.size(); ++d) {
    rows += head;
    for (const double value :
         {result.depth[d], result.force[d], result.reference_force[d], result.reference_error[d],
          result.error[d], defect, number_at(summary, "wall_time")})
      rows += "," + meshes::to_text(value);
    rows += "," + csv_cell(status) + "\n";
  }
  return rows;
}

ordered_json list_of(const std::vector<double>& values) {
  ordered_json list = ordered_json::array();
  for (const double value : values) list.push_back(number_or_null(value));
  return list;
}

ordered_json VariantsPlan::series_entries() const {
  ordered_json list = ordered_json::array();
  for (const std::string& name : series_names(case_)) {
    const SeriesMeasures measures = measure_series(case_, name, results_);
    list.push_back({{"name", name},
                    {"worst_error", number_or_null(measures.worst_error)},
                    {"finest_error", number_or_null(measures.finest_error)},
                    {"spread", number_or_null(measures.spread)},
                    {"order", number_or_null(measures.order)}});
  }
  return list;
}

ordered_json VariantsPlan::continuum_entries() const {
  ordered_json list = ordered_json::array();
  for (const Continuum& continuum : continua_) {
    const meshes::Rubber& rubber = continuum.order.rubber;
    list.push_back({{"folder", continuum.folder},
                    {"strain", fem_reference::name(continuum.order.strain)},
                    {"contact", meshes::name(continuum.order.protocol.contact)},
                    {"youngs_modulus", rubber.youngs_modulus},
                    {"shear_modulus", rubber.shear_modulus},
                    {"poissons_ratio", rubber.poissons_ratio()}});
  }
  return list;
}

ordered_json VariantsPlan::budget_entries() const {
  ordered_json list = ordered_json::array();
  for (const CaseBudget& budget : case_.budgets) {
    const Budget taken = take_budget(case_, budget, results_);
    ordered_json parts = ordered_json::array();
    for (std::size_t i = 0; i < budget.parts.size(); ++i)
      parts.push_back({{"series", budget.parts[i]}, {"share", list_of(taken.parts[i])}});
    list.push_back({{"name", budget.name},
                    {"depths", list_of(taken.depth)},
                    {"total", list_of(taken.total)},
                    {"parts", parts},
                    {"rest", list_of(taken.rest)}});
  }
  return list;
}

ordered_json VariantsPlan::conclude(const fs::path& folder, const std::vector<JobResult>& results) {
  std::string rows;
  for (std::size_t i = 0; i < presses_.size(); ++i) {
    results_.push_back(result_of(presses_[i], folder));
    const auto job = std::ranges::find(results, presses_[i].folder, &JobResult::name);
    if (!job->ok()) ++not_converged_;
    rows += rows_of(i, folder, job->status);
  }
  meshes::write_atomically(folder / "variants.csv",
                           [&](std::ostream& out) { out << table_head << rows; });
  return {{"variants",
           {{"x_label", case_.abscissa},
            {"count", presses_.size()},
            {"not_converged", not_converged_},
            {"series", series_entries()},
            {"continua", continuum_entries()},
            {"budgets", budget_entries()}}}};
}

std::map<std::string, double> VariantsPlan::measures(const fs::path&, const ordered_json&) const {
  return take_variant_measures(case_, results_, not_converged_);
}

}  // namespace

std::unique_ptr<Plan> variants_plan(const Case& one) {
  return std::make_unique<VariantsPlan>(one);
}

}  // namespace fingertip::studies
