#include "studies/cases/outputs.h"

#include <algorithm>

#include "studies/cases/measures.h"
#include "studies/run/json_file.h"

namespace fingertip::studies {

namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

ordered_json list_of(const std::vector<double>& values) {
  ordered_json list = ordered_json::array();
  for (const double value : values) list.push_back(number_or_null(value));
  return list;
}

ordered_json measure_of(const RunResult& result, const std::string& name) {
  const auto found = result.measures.find(name);
  return found == result.measures.end() ? ordered_json() : ordered_json(found->second);
}

/// The continuum that the presses of the verdict are measured against.
void add_reference(const Case& one, const RunResult& run, const fs::path& folder,
                   ordered_json& summary) {
  const meshes::Rubber& rubber = one.loaded.config.press.rubber;
  const meshes::PressResponse response = response_in(folder / run.folder);
  const ForceComparison itself =
      compare_forces(response, response, verdict_depths(one.loaded.config.press.protocol.depth));
  summary["target"] = {{"youngs_modulus", rubber.youngs_modulus},
                       {"shear_modulus", rubber.shear_modulus},
                       {"poissons_ratio", rubber.poissons_ratio()},
                       {"bulk_modulus", rubber.bulk_modulus()}};
  summary["depths"] = itself.depth;
  summary["reference"] = {{"status", run.status},
                          {"force", list_of(itself.force)},
                          {"relative_force_error", list_of(itself.reference_error)}};
}

void add_verification(const RunResult& run, const fs::path& folder, ordered_json& summary) {
  const JsonEntry found = read_entry(folder / run.folder / "verification.json");
  summary["verification"] = {{"checks", array_at(found, "checks").size()},
                             {"failed_checks", std::size_t(run.measures.at("failed_checks"))}};
}

ordered_json model_entry(const RunResult& press, const fs::path& folder) {
  ordered_json entry;
  const fs::path file = folder / press.folder / "summary.json";
  if (fs::exists(file)) {
    const ordered_json own = read_json(file);
    // A press at rest has neither.
    entry = own.value("moduli", ordered_json::object());
    entry["real_time_factor"] = own.value("real_time_factor", ordered_json());
  }
  entry["force_error"] = list_of(press.forces.error);
  entry["relative_l2_force_error"] = number_or_null(press.forces.l2_error);
  entry["status"] = press.ok() ? "ok" : press.status;
  return entry;
}

/// Of [[case.run]].
void add_verdict(const Case& one, const RunResults& results, const fs::path& folder,
                 ordered_json& summary) {
  ordered_json models;
  for (const RunResult* result : members(results, "run")) {
    const CaseRun& run = *result->run;
    if (run.verb == "reference") add_reference(one, *result, folder, summary);
    if (run.verb == "verification") add_verification(*result, folder, summary);
    if (run.is_verdict() && run.series.empty()) models[run.name] = model_entry(*result, folder);
    if (full_name(run) == "equilibrium, hookean")
      summary["equilibrium"] = {{"hookean_force_error", list_of(result->forces.error)}};
  }
  if (!models.empty()) summary["models"] = models;
}

ordered_json series_entries(const RunResults& results) {
  ordered_json list = ordered_json::array();
  for (const std::string& name : series_names(results, "variant")) {
    const SeriesMeasures measures = measure_series(members(results, "variant", name));
    list.push_back({{"name", name},
                    {"worst_error", number_or_null(measures.worst_error)},
                    {"finest_error", number_or_null(measures.finest_error)},
                    {"spread", number_or_null(measures.spread)},
                    {"order", number_or_null(measures.order)}});
  }
  return list;
}

/// Those of the variants.
ordered_json continuum_entries(const Planner& planner, const Members& variants) {
  ordered_json list = ordered_json::array();
  for (const Continuum& continuum : planner.continua()) {
    if (std::ranges::find(variants, continuum.folder, &RunResult::against) == variants.end())
      continue;
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

ordered_json budget_entries(const Case& one, const RunResults& results) {
  ordered_json list = ordered_json::array();
  for (const CaseBudget& budget : one.budgets) {
    const Budget taken = take_budget(budget, results);
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

ordered_json variants_entry(const Case& one, const Planner& planner, const RunResults& results) {
  const Members variants = members(results, "variant");
  const auto lost = std::ranges::count(variants, false, &RunResult::ok);
  return {{"x_label", one.abscissa},
          {"count", variants.size()},
          {"not_converged", lost},
          {"series", series_entries(results)},
          {"continua", continuum_entries(planner, variants)},
          {"budgets", budget_entries(one, results)}};
}

ordered_json calibration_entry(const Case& one, const RunResults& results) {
  ordered_json fits = ordered_json::array(), predictions = ordered_json::array(),
               worst = ordered_json::array();
  for (const CaseRun& run : one.runs)
    if (run.is("prediction")) predictions.push_back({{"name", run.name}});
  for (const RunResult* fit : members(results, "fit")) {
    const std::string problem = text_at(fit->summary, "problem");
    fits.push_back({{"name", fit->run->name},
                    {"folder", fit->folder},
                    {"model", text_at(fit->summary, "model")},
                    {"problem", problem.empty() ? "moduli" : problem}});
    ordered_json row = ordered_json::array();
    for (const CaseRun& run : one.runs) {
      if (!run.is("prediction")) continue;
      const auto press = std::ranges::find_if(results, [&](const RunResult& other) {
        return other.fit == fit->run && other.run == &run;
      });
      row.push_back(press == results.end() ? ordered_json() : measure_of(*press, "worst_error"));
    }
    worst.push_back(row);
  }
  const meshes::Rubber& rubber = one.loaded.config.press.rubber;
  return {{"fits", fits},
          {"predictions", predictions},
          {"worst_error", worst},
          {"truth",
           {{"parameters",
             {{"youngs_modulus", rubber.youngs_modulus},
              {"shear_modulus", rubber.shear_modulus},
              {"lambda", rubber.lame_lambda()},
              {"retardation_time", rubber.retardation_time}}}}}};
}

/// Presses in time or grasps, one by one.
ordered_json run_entries(const RunResults& results, const std::string& kind) {
  ordered_json list = ordered_json::array();
  for (const RunResult* result : members(results, kind)) {
    const CaseRun& run = *result->run;
    ordered_json entry = {{"series", run.series}, {"name", run.name}, {"folder", result->folder}};
    if (kind == "press") {
      entry["continuum"] = result->against;
      entry["beside"] = run.beside;
      entry["pictured"] = run.snapshots;
    }
    entry["status"] = result->status;
    for (const auto& [name, value] : result->measures) entry[name] = value;
    list.push_back(std::move(entry));
  }
  return list;
}

}  // namespace

ordered_json summary_of(const Case& one, const Planner& planner, const RunResults& results,
                        const fs::path& folder) {
  const auto has = [&](const char* kind) { return !members(results, kind).empty(); };
  ordered_json summary = ordered_json::object();
  add_verdict(one, results, folder, summary);
  if (has("variant")) summary["variants"] = variants_entry(one, planner, results);
  if (has("fit")) summary["calibration"] = calibration_entry(one, results);
  if (has("press")) summary["presses"] = run_entries(results, "press");
  if (has("grasp")) summary["grasps"] = run_entries(results, "grasp");
  return summary;
}

}  // namespace fingertip::studies
