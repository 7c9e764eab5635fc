#include "studies/cases/measures.h"

#include <cmath>

namespace fingertip::studies::inline cases {

namespace {

/// Enters a measure of one of several; they have the largest, and NaN when one of them has none.
void enter(const std::string& name, double value, Measures& all) {
  const auto [entry, is_new] = all.insert({name, value});
  if (!is_new) entry->second = larger(entry->second, value);
}

/// Every name under which a measure of the run is judged.
std::vector<std::string> judged_names(const RunResult& result, const std::string& measure) {
  const CaseRun& run = *result.run;
  if (result.fit != nullptr)
    return {result.fit->name + "." + run.name, result.fit->name + "." + measure,
            "transfer." + measure};
  if (run.is("fit")) return {run.name + "." + measure};
  std::vector<std::string> names = {full_name(run) + "." + measure};
  if (!run.series.empty()) names.push_back(run.series + "." + measure);
  if (run.is("variant")) names.push_back("variants." + measure);
  return names;
}

/// NaN where nothing is known, so that every measure has its name.
Measures all_measures_of(const Case& study_case, const RunResults& results) {
  Measures all;
  for (const RunResult& result : results) {
    for (const std::string& measure : measures_meant(*result.run)) {
      const auto found = result.measures.find(measure);
      const double value = found == result.measures.end() ? meshes::unknown : found->second;
      for (const std::string& name : judged_names(result, measure)) enter(name, value, all);
    }
    static const std::map<std::string, std::string> counted = {
        {"variant", "variants"}, {"press", "presses"}, {"grasp", "grasps"}};
    if (const auto kind = counted.find(result.run->kind); kind != counted.end())
      all[kind->second + ".not_converged"] += result.ok() ? 0.0 : 1.0;
    if (result.run->is("variant") || result.run->continuum)
      enter("reference.force_error", largest(result.forces.reference_error), all);
  }
  for (const std::string& series : series_names(results, "variant")) {
    const SeriesMeasures measures = measure_series(members(results, "variant", series));
    all[series + ".finest_error"] = measures.finest_error;
    all[series + ".spread"] = measures.spread;
  }
  for (const std::string& series : series_names(results, "grasp"))
    all[series + ".limit_error"] = limit_error(members(results, "grasp", series));
  for (const std::string& series : series_names(results, "material"))
    all[series + ".end_ratio_span"] = end_ratio_span(members(results, "material", series));
  for (const CaseBudget& budget : study_case.budgets)
    all[budget.name + ".rest"] = largest(take_budget(budget, results).rest);
  // The press of the core case whose error is known by this name.
  if (const auto found = all.find("equilibrium, hookean.max_force_error"); found != all.end())
    all["equilibrium.hookean_force_error"] = found->second;
  return all;
}

}  // namespace

std::vector<std::string> measure_names(const Case& study_case) {
  std::vector<std::string> names;
  for (const auto& [name, value] : all_measures_of(study_case, blank_results(study_case)))
    names.push_back(name);
  return names;
}

Measures take_measures(const Case& study_case, const RunResults& results) {
  Measures taken = all_measures_of(study_case, results);
  std::erase_if(taken, [](const auto& entry) { return std::isnan(entry.second); });
  return taken;
}

}  // namespace fingertip::studies::inline cases
