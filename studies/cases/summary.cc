#include "studies/cases/outputs.h"

#include <algorithm>

#include "fem_reference/verification/verification_file.h"
#include "meshes/tables/fields_json.h"
#include "studies/cases/measures.h"
#include "studies/files/read_fields.h"

namespace fingertip::studies::inline cases {

namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

std::vector<CriterionEntry> judged(const std::vector<CaseCriterion>& criteria,
                                   const Measures& measures) {
  std::vector<CriterionEntry> list;
  for (const CaseCriterion& criterion : criteria) {
    const auto found = measures.find(criterion.measure);
    const double value = found == measures.end() ? meshes::unknown : found->second;
    list.push_back(
        {criterion.name, criterion.measure, value, criterion.limit, value <= criterion.limit});
  }
  return list;
}

/// The continuum that the presses of the verdict are measured against.
void add_reference(const Case& study_case, const RunResult& run, const fs::path& folder,
                   CaseSummary& summary) {
  const meshes::Rubber& rubber = study_case.loaded.config.press.rubber;
  const meshes::PressResponse response = response_in(folder / run.folder);
  const ForceComparison itself = compare_forces(
      response, response, verdict_depths(study_case.loaded.config.press.protocol.depth));
  summary.target = TargetEntry{rubber.youngs_modulus, rubber.shear_modulus, rubber.poissons_ratio(),
                               rubber.bulk_modulus()};
  summary.depths = itself.depth;
  summary.reference = ReferenceEntry{run.status, itself.force, itself.reference_error};
}

VerificationEntry verification_entry(const RunResult& run, const fs::path& folder) {
  const auto found = struct_of<fem_reference::VerificationFile>(
      read_entry(folder / run.folder / "verification.json"));
  return {found.checks.size(), std::size_t(run.measures.at("failed_checks"))};
}

ModelEntry model_entry(const RunResult& result) {
  const PressSummary& press = result.press;
  ModelEntry entry;
  static_cast<ModuliEntry&>(entry) = press.moduli;
  entry.in_time = !press.empty() && press.moves();
  entry.real_time_factor = press.real_time_factor;
  entry.force_error = result.forces.error;
  entry.relative_l2_force_error = result.forces.l2_error;
  entry.status = result.ok() ? "ok" : result.status;
  return entry;
}

/// Of [[case.run]].
void add_verdict(const Case& study_case, const RunResults& results, const fs::path& folder,
                 CaseSummary& summary) {
  for (const RunResult* result : members(results, "run")) {
    const CaseRun& run = *result->run;
    if (run.verb == "reference") add_reference(study_case, *result, folder, summary);
    if (run.verb == "verification") summary.verification = verification_entry(*result, folder);
    if (run.is_verdict() && run.series.empty()) summary.models[run.name] = model_entry(*result);
    if (full_name(run) == "equilibrium, hookean")
      summary.equilibrium = EquilibriumEntry{result->forces.error};
  }
}

std::vector<SeriesEntry> series_entries(const RunResults& results) {
  std::vector<SeriesEntry> list;
  for (const std::string& name : series_names(results, "variant")) {
    const SeriesMeasures measures = measure_series(members(results, "variant", name));
    list.push_back(
        {name, measures.worst_error, measures.finest_error, measures.spread, measures.order});
  }
  return list;
}

/// Those of the variants.
std::vector<ContinuumEntry> continuum_entries(const Planner& planner, const Members& variants) {
  std::vector<ContinuumEntry> list;
  for (const Continuum& continuum : planner.continua()) {
    if (std::ranges::find(variants, continuum.folder, &RunResult::against) == variants.end())
      continue;
    const meshes::Rubber& rubber = continuum.reference.rubber;
    list.push_back({continuum.folder, std::string(fem_reference::name(continuum.reference.strain)),
                    std::string(meshes::name(continuum.reference.protocol.contact)),
                    rubber.youngs_modulus, rubber.shear_modulus, rubber.poissons_ratio()});
  }
  return list;
}

std::vector<BudgetEntry> budget_entries(const Case& study_case, const RunResults& results) {
  std::vector<BudgetEntry> list;
  for (const CaseBudget& budget : study_case.budgets) {
    const Budget taken = take_budget(budget, results);
    BudgetEntry entry{budget.name, taken.depth, taken.total, {}, taken.rest};
    for (std::size_t i = 0; i < budget.parts.size(); ++i)
      entry.parts.push_back({budget.parts[i], taken.parts[i]});
    list.push_back(std::move(entry));
  }
  return list;
}

std::vector<DrawnEntry> drawn_entries(const Members& variants) {
  std::vector<DrawnEntry> list;
  for (const RunResult* result : variants)
    if (result->run->snapshots)
      list.push_back({full_name(*result->run), result->folder, result->against});
  return list;
}

StudyEntry study_entry(const Case& study_case, const Planner& planner, const RunResults& results) {
  const Members variants = members(results, "variant");
  const auto lost = std::size_t(std::ranges::count(variants, false, &RunResult::ok));
  return {study_case.abscissa,
          variants.size(),
          lost,
          series_entries(results),
          continuum_entries(planner, variants),
          budget_entries(study_case, results),
          drawn_entries(variants)};
}

TransferEntry transfer_entry(const Case& study_case, const RunResults& results) {
  TransferEntry entry;
  for (const CaseRun& run : study_case.runs)
    if (run.is("prediction")) entry.predictions.push_back({run.name});
  for (const RunResult* fit : members(results, "fit")) {
    entry.fits.push_back({fit->run->name, fit->folder, fit->found.model, fit->found.problem});
    std::vector<double>& row = entry.worst_error.emplace_back();
    for (const CaseRun& run : study_case.runs) {
      if (!run.is("prediction")) continue;
      const auto press = std::ranges::find_if(results, [&](const RunResult& other) {
        return other.fit == fit->run && other.run == &run;
      });
      row.push_back(press == results.end() ? meshes::unknown : largest(press->forces.error));
    }
  }
  const meshes::Rubber& rubber = study_case.loaded.config.press.rubber;
  entry.truth.parameters = {{"youngs_modulus", rubber.youngs_modulus},
                            {"shear_modulus", rubber.shear_modulus},
                            {"lambda", rubber.lame_lambda()},
                            {"retardation_time", rubber.retardation_time}};
  return entry;
}

/// Appends its measures to each entry of a list.
void add_measures(const Members& runs, ordered_json& list) {
  for (std::size_t i = 0; i < runs.size(); ++i)
    for (const auto& [name, value] : runs[i]->measures) list[i][name] = value;
}

}  // namespace

CaseSummary summary_of(const Case& study_case, const Planner& planner, const RunResults& results,
                       const fs::path& folder) {
  CaseSummary summary;
  summary.case_name = study_case.name;
  summary.title = study_case.title;
  summary.description = study_case.description;
  add_verdict(study_case, results, folder, summary);
  if (!members(results, "variant").empty())
    summary.variants = study_entry(study_case, planner, results);
  if (!members(results, "fit").empty()) summary.calibration = transfer_entry(study_case, results);
  for (const RunResult* press : members(results, "press"))
    summary.presses.push_back({press->run->series, press->run->name, press->folder, press->against,
                               press->run->beside, press->run->snapshots, press->status});
  for (const RunResult* grasp : members(results, "grasp"))
    summary.grasps.push_back({grasp->run->series, grasp->run->name, grasp->folder, grasp->status});
  for (const RunResult* fit : members(results, "material"))
    summary.materials.push_back({fit->run->series, fit->run->name, fit->folder, fit->run->law,
                                 fit->run->test, fit->status});
  summary.criteria = judged(study_case.criteria, take_measures(study_case, results));
  const bool passed = std::ranges::all_of(summary.criteria, &CriterionEntry::passed);
  summary.status = passed ? "ok" : "criteria failed";
  return summary;
}

void write_summary(const CaseSummary& summary, const RunResults& results, const fs::path& file) {
  ordered_json content = json_of(summary);
  if (!summary.presses.empty()) add_measures(members(results, "press"), content["presses"]);
  if (!summary.grasps.empty()) add_measures(members(results, "grasp"), content["grasps"]);
  if (!summary.materials.empty()) add_measures(members(results, "material"), content["materials"]);
  meshes::write_json_file(content, file);
}

}  // namespace fingertip::studies::inline cases
