#include "studies/cases/measures.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "meshes/csv_table.h"
#include "studies/report/moving_press.h"

namespace fingertip::studies {

namespace {

namespace fs = std::filesystem;

/// What a measure may look at.
struct Evidence {
  const Case& one;
  const RunResult& result;
  fs::path place;  ///< of the run

  double number(const char* key) const { return number_at(result.summary, key); }
  const meshes::Rubber& rubber() const { return one.loaded.config.press.rubber; }
  meshes::CsvTable table(const char* name) const {
    return fs::exists(place / name) ? meshes::read_csv(place / name) : meshes::CsvTable();
  }
};

using Roles = std::vector<std::string>;

struct RunMeasure {
  std::string name;
  Roles roles;  ///< of the runs that it is meant for
  std::function<double(const Evidence&)> take;
};

/// |value/wanted - 1|
double relative_error(double value, double wanted) {
  return std::abs(value / wanted - 1.0);
}

/// As what a run is measured: its kind, with the verb where that is its own, and what it is beside.
Roles roles_of(const CaseRun& run) {
  Roles all = {run.is("run") ? "run " + run.verb : run.kind};
  if (run.is("press") && run.continuum) all.emplace_back("beside continuum");
  if (run.is("press") && !run.beside.empty()) all.emplace_back("beside press");
  return all;
}

// What needs more than a number of summary.json.

double failed_checks(const Evidence& run) {
  const fs::path file = run.place / "verification.json";
  if (!fs::exists(file)) return meshes::unknown;
  return double(
      std::ranges::count_if(array_at(read_entry(file), "checks"),
                            [](const JsonEntry& check) { return !check.at("passed").flag(); }));
}

/// Largest relative deviation of the hookean cubes in cubes.csv from the rubber's E, G, nu.
double cube_error(const Evidence& run) {
  const std::pair<const char*, double> wanted[] = {
      {"youngs_modulus_100 [Pa]", run.rubber().youngs_modulus},
      {"youngs_modulus_110 [Pa]", run.rubber().youngs_modulus},
      {"youngs_modulus_111 [Pa]", run.rubber().youngs_modulus},
      {"shear_modulus [Pa]", run.rubber().shear_modulus},
      {"poissons_ratio_100", run.rubber().poissons_ratio()}};
  const meshes::CsvTable cubes = run.table("cubes.csv");
  if (cubes.empty()) return meshes::unknown;
  const std::vector<std::string> models = cubes.texts("model");
  std::vector<double> errors;
  for (const auto& [column, target] : wanted) {
    const std::vector<double> values = cubes.numbers(column);
    for (std::size_t row = 0; row < values.size(); ++row)
      if (models[row] == "hookean")
        errors.push_back((values[row] - target) / std::max(std::abs(target), 1e-3));
  }
  return largest(errors);
}

double youngs_modulus_error(const Evidence& run) {
  const JsonEntry moduli = object_at(run.result.summary, "moduli");
  std::vector<double> errors;
  for (const char* direction : {"E_100", "E_110", "E_111"})
    errors.push_back(number_at(moduli, direction) / run.rubber().youngs_modulus - 1.0);
  return largest(errors);
}

bool is_held(const Evidence& run) {
  return text_at(run.result.summary, "fate") == "held";
}

/// A parameter of a fit; empty where it was not fitted. Estimates of a search that did not end are
/// none.
JsonEntry parameter(const Evidence& run, const std::string& name) {
  const JsonEntry& fit = run.result.summary;
  if (fit.contains("converged") && !fit.at("converged").flag()) return {};
  for (const JsonEntry& one : array_at(fit, "parameters"))
    if (text_at(one, "name") == name) return one;
  return {};
}

/// 0 inside the interval, else how far outside, over the truth.
double outside(const JsonEntry& parameter, double truth) {
  if (std::isnan(number_at(parameter, "estimate"))) return meshes::unknown;
  const double below = number_at(parameter, "lower") - truth;
  const double above = truth - number_at(parameter, "upper");
  return larger(larger(below, above), 0.0) / std::abs(truth);
}

double open_directions(const Evidence& run) {
  return run.result.summary.empty() ? meshes::unknown
                                    : double(array_at(run.result.summary, "unidentifiable").size());
}

// The table.

RunMeasure in_summary(const char* name, Roles meant, const char* object = "") {
  return {name, std::move(meant), [name, object](const Evidence& run) {
            const JsonEntry& summary = run.result.summary;
            return number_at(*object == '\0' ? summary : object_at(summary, object), name);
          }};
}

/// Of a modulus in the press's summary against the case's rubber.
RunMeasure modulus_error(const char* name, const char* modulus,
                         std::function<double(const meshes::Rubber&)> wanted) {
  return {name, {"run press"}, [=](const Evidence& run) {
            const JsonEntry moduli = object_at(run.result.summary, "moduli");
            return relative_error(number_at(moduli, modulus), wanted(run.rubber()));
          }};
}

/// Of a grasp's number against another one.
RunMeasure grasp_error(const char* name, const char* number, const char* wanted) {
  return {name, {"grasp"}, [=](const Evidence& run) {
            return relative_error(run.number(number), run.number(wanted));
          }};
}

std::vector<RunMeasure> all_measures() {
  using R = const Evidence&;
  using meshes::Rubber;
  std::vector<RunMeasure> all = {
      {"failed_checks", {"run verification"}, failed_checks},
      {"hookean_error", {"run cubes"}, cube_error},
      {"youngs_modulus_error", {"run press"}, youngs_modulus_error},
      modulus_error("shear_modulus_error", "G", [](const Rubber& r) { return r.shear_modulus; }),
      modulus_error("bulk_modulus_error", "K", [](const Rubber& r) { return r.bulk_modulus(); }),
      {"poissons_ratio_error",
       {"run press"},
       [](R run) {
         const JsonEntry moduli = object_at(run.result.summary, "moduli");
         return std::abs(number_at(moduli, "nu_100") - run.rubber().poissons_ratio());
       }},
      {"max_force_error", {"run press"}, [](R run) { return largest(run.result.forces.error); }},
      {"l2_force_error", {"run press"}, [](R run) { return run.result.forces.l2_error; }},
      in_summary("speed_deviation", {"run press", "press"}, "tracking"),
      in_summary("speed_deviation_at_touch", {"run press", "press"}, "tracking"),
      in_summary("tilt_deg", {"run press", "press"}, "tracking"),
      in_summary("momentum_defect", {"run press", "press"}),
      {"force_overshoot",
       {"press"},
       [](R run) { return reporting::force_overshoot(run.table("trace.csv")); }},
      {"mode_switches",
       {"press"},
       [](R run) { return reporting::mode_switches(run.table("trace.csv")); }},
      {"force_error", {"beside continuum"}, [](R run) { return largest(run.result.forces.error); }},
      {"change", {"beside press"}, [](R run) { return largest(run.result.change.error); }},
      {"worst_error",
       {"variant", "prediction"},
       [](R run) { return largest(run.result.forces.error); }},
      {"held", {"grasp"}, [](R run) { return is_held(run) ? 1.0 : 0.0; }},
      {"lost", {"grasp"}, [](R run) { return is_held(run) ? 0.0 : 1.0; }},
      {"surplus",
       {"grasp"},
       [](R run) { return run.number("wanted_force") / run.number("least_force") - 1.0; }},
      grasp_error("slip_error", "slip_ratio", "friction"),
      grasp_error("sliding_error", "sliding_ratio", "friction"),
      // Where the grip does not fall, the force of slip is the one that was asked for.
      {"slip_force_error",
       {"grasp"},
       [](R run) {
         return is_held(run)
                    ? relative_error(run.number("slip_force"), run.number("least_force_at_rest"))
                    : meshes::unknown;
       }},
      {"load_error", {"grasp"}, [](R run) { return relative_error(run.number("held_load"), 1.0); }},
      in_summary("momentum_defect", {"grasp"}),
      {"open_directions", {"fit"}, open_directions},
      {"claims_certainty", {"fit"}, [](R run) {
         const double open = open_directions(run);
         return std::isnan(open) ? open : open > 0.0 ? 0.0 : 1.0;
       }}};
  // What a fit's parameter should be: the case's own rubber.
  const std::pair<std::string, double (*)(const Rubber&)> parameters[] = {
      {"youngs_modulus", [](const Rubber& r) { return r.youngs_modulus; }},
      {"shear_modulus", [](const Rubber& r) { return r.shear_modulus; }},
      {"lame_shear", [](const Rubber& r) { return r.shear_modulus; }},
      {"lambda", [](const Rubber& r) { return r.lame_lambda(); }},
      {"retardation_time", [](const Rubber& r) { return r.retardation_time; }}};
  for (const auto& [name, truth] : parameters) {
    all.push_back({name + "_error", {"fit"}, [name, truth](R run) {
                     const double estimate = number_at(parameter(run, name), "estimate");
                     return relative_error(estimate, truth(run.rubber()));
                   }});
    all.push_back({name + "_outside", {"fit"}, [name, truth](R run) {
                     return outside(parameter(run, name), truth(run.rubber()));
                   }});
  }
  return all;
}

/// The measures that are meant for the run.
std::vector<RunMeasure> meant(const CaseRun& run) {
  static const std::vector<RunMeasure> table = all_measures();
  const Roles own = roles_of(run);
  std::vector<RunMeasure> measures;
  std::ranges::copy_if(table, std::back_inserter(measures), [&](const RunMeasure& measure) {
    return std::ranges::find_first_of(measure.roles, own) != measure.roles.end();
  });
  return measures;
}

}  // namespace

std::vector<std::string> measures_meant(const CaseRun& run) {
  std::vector<std::string> names;
  for (const RunMeasure& measure : meant(run)) names.push_back(measure.name);
  return names;
}

Measures measures_of_run(const Case& one, const RunResult& result, const fs::path& place) {
  Measures taken;
  const CaseRun& run = *result.run;
  if ((run.is("press") || run.is("grasp")) && !result.ok()) return taken;
  for (const RunMeasure& measure : meant(run)) {
    const double value = measure.take({one, result, place});
    if (std::isfinite(value)) taken[measure.name] = value;
  }
  return taken;
}

}  // namespace fingertip::studies
