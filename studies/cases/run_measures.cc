#include "studies/cases/measures.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "calibration/material_tests/law_record.h"
#include "fem_reference/verification/verification_file.h"
#include "lattice/press/trace.h"
#include "meshes/tables/table_rows.h"
#include "studies/files/read_fields.h"
#include "studies/files/run_tables.h"
#include "studies/report/results/moving_press.h"

namespace fingertip::studies::inline cases {

namespace {

namespace fs = std::filesystem;

/// What a measure may look at.
struct Evidence {
  const Case& study_case;
  const RunResult& result;
  fs::path place;  ///< of the run

  const PressSummary& press() const { return result.press; }
  const GraspSummary& grasp() const { return result.grasp; }
  const meshes::Rubber& rubber() const { return study_case.loaded.config.press.rubber; }
  template <typename Row>
  std::vector<Row> rows(const char* name) const {
    return fs::exists(place / name) ? meshes::read_rows<Row>(place / name) : std::vector<Row>();
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
  if (run.is("variant") && run.snapshots) all.emplace_back("drawn");
  if (!run.displacements.empty()) all.emplace_back("displaced");
  if (run.is("press") && run.continuum) all.emplace_back("beside continuum");
  if (!run.is("run") && !run.beside.empty()) all.emplace_back("beside press");
  return all;
}

// What needs more than a number of summary.json.

double failed_checks(const Evidence& run) {
  const fs::path file = run.place / "verification.json";
  if (!fs::exists(file)) return meshes::unknown;
  const auto found = struct_of<fem_reference::VerificationFile>(read_entry(file));
  return double(std::ranges::count(found.checks, false, &fem_reference::Check::passed));
}

/// Largest relative deviation of the hookean cubes in cubes.csv from the rubber's E, G, nu.
double cube_error(const Evidence& run) {
  const std::pair<double CubeRow::*, double> wanted[] = {
      {&CubeRow::youngs_modulus_100, run.rubber().youngs_modulus},
      {&CubeRow::youngs_modulus_110, run.rubber().youngs_modulus},
      {&CubeRow::youngs_modulus_111, run.rubber().youngs_modulus},
      {&CubeRow::shear_modulus, run.rubber().shear_modulus},
      {&CubeRow::poissons_ratio_100, run.rubber().poissons_ratio()}};
  std::vector<double> errors;
  for (const CubeRow& cube : run.rows<CubeRow>("cubes.csv")) {
    if (cube.model != "hookean") continue;
    for (const auto& [value, target] : wanted)
      errors.push_back((cube.*value - target) / std::max(std::abs(target), 1e-3));
  }
  return largest(errors);
}

double youngs_modulus_error(const Evidence& run) {
  std::vector<double> errors;
  for (const auto direction : {&ModuliEntry::E_100, &ModuliEntry::E_110, &ModuliEntry::E_111})
    errors.push_back(run.press().moduli.*direction / run.rubber().youngs_modulus - 1.0);
  return largest(errors);
}

/// Of the forces after the first loading, over the largest of the continuum's.
double later_error(const Evidence& run) {
  std::vector<double> errors;
  for (const LaterForce& later : run.result.forces.later) errors.push_back(later.error);
  return largest(errors);
}

/// Of the forces in holds, over the continuum's own.
double hold_error(const Evidence& run) {
  const std::vector<meshes::PressStage>& program = run.result.setup.protocol.program;
  std::vector<double> errors;
  for (const LaterForce& later : run.result.forces.later)
    if (!program.at(std::size_t(later.stage) - 1).moves())
      errors.push_back(later.force / later.reference_force - 1.0);
  return largest(errors);
}

bool is_held(const Evidence& run) {
  return run.grasp().fate == "held";
}

using calibration::ParameterEntry;

/// A parameter of a fit; unknown where it was not fitted. Estimates of a search that did not end
/// are none.
ParameterEntry parameter(const Evidence& run, const std::string& name) {
  const calibration::FitFile& fit = run.result.found;
  const auto found = std::ranges::find(fit.parameters, name, &ParameterEntry::name);
  return fit.converged && found != fit.parameters.end() ? *found : ParameterEntry();
}

/// 0 inside the interval, else how far outside, over the truth.
double outside(const ParameterEntry& parameter, double truth) {
  if (std::isnan(parameter.estimate)) return meshes::unknown;
  const double below = parameter.lower - truth;
  const double above = truth - parameter.upper;
  return larger(larger(below, above), 0.0) / std::abs(truth);
}

double open_directions(const Evidence& run) {
  const calibration::FitFile& fit = run.result.found;
  return fit.empty() ? meshes::unknown : double(fit.unidentifiable.size());
}

/// 1/times: how much of its interval a parameter keeps where the one that is most like it is known.
double told_apart(const Evidence& run) {
  const auto& rows = run.result.found.correlation;
  if (rows.empty()) return meshes::unknown;
  double least = 1.0;
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      least = std::min(least, std::sqrt(std::max(0.0, 1.0 - rows[i][j] * rows[i][j])));
  return least;
}

using calibration::LawTestEntry;

/// How the run's laws meet the tests it asks of, those fitted ("fit") or held back ("predict");
/// empty where a law has no fit.
std::vector<LawTestEntry> law_tests(const Evidence& run, std::string_view use) {
  const CaseRun& asked = *run.result.run;
  std::vector<LawTestEntry> found;
  for (const calibration::LawEntry& law : run.result.laws.laws) {
    if (!asked.law.empty() && law.law != asked.law) continue;
    if (!law.failure.empty()) return {};
    for (const LawTestEntry& test : law.tests)
      if (test.use == use && (asked.test.empty() || test.name == asked.test)) found.push_back(test);
  }
  return found;
}

/// The largest magnitude of `value` over the tests.
RunMeasure of_laws(const char* name, const char* use, double (*value)(const LawTestEntry&)) {
  return {name, {"material"}, [use, value](const Evidence& run) {
            std::vector<double> values;
            for (const LawTestEntry& test : law_tests(run, use)) values.push_back(value(test));
            return largest(values);
          }};
}

/// Of sums of squares over those that others published, where they did.
double squares_error(const Evidence& run) {
  std::vector<double> errors;
  for (const LawTestEntry& test : law_tests(run, "fit"))
    if (std::isfinite(test.published)) errors.push_back(test.sum_of_squares / test.published - 1.0);
  return largest(errors);
}

/// Measured stress over that of the run's law where a predicted test goes farthest from rest.
double end_ratio(const Evidence& run) {
  const auto rows = run.rows<calibration::LawDataRow>("law_data.csv");
  std::vector<double> ratios;
  for (const LawTestEntry& test : law_tests(run, "predict")) {
    const double rest = test.kind == "simple-shear" ? 0.0 : 1.0;
    const calibration::LawDataRow* last = nullptr;
    for (const auto& row : rows) {
      if (row.law != run.result.run->law || row.use != "predict" || row.test != test.name) continue;
      const auto distance = [&](const auto& at) { return std::abs(at.deformation - rest); };
      if (last == nullptr || distance(row) > distance(*last)) last = &row;
    }
    ratios.push_back(last == nullptr ? meshes::unknown : last->measured / last->computed);
  }
  return largest(ratios);
}

/// So many the statement of a fit names.
constexpr std::size_t told_suspects = 3;

/// 0 where one of `names` is among the first `count` suspects of a misfit and beyond chance;
/// else 1.
RunMeasure suspects(const char* name, std::size_t count, std::vector<std::string> names) {
  return {name, {"fit"}, [count, names](const Evidence& run) {
            const calibration::FitFile& fit = run.result.found;
            if (fit.empty()) return meshes::unknown;
            for (std::size_t i = 0; i < std::min(count, fit.lack_of_fit.size()); ++i)
              if (fit.lack_of_fit[i].probability < calibration::by_no_chance &&
                  std::ranges::find(names, fit.lack_of_fit[i].name) != names.end())
                return 0.0;
            return 1.0;
          }};
}

// The table.

/// How a press's controller did.
RunMeasure of_tracking(const char* name, double TrackingEntry::*number) {
  return {name, {"run press", "press"}, [number](const Evidence& run) {
            return run.press().tracking.*number;
          }};
}

/// Of a modulus in the press's summary against the case's rubber.
RunMeasure modulus_error(const char* name, double ModuliEntry::*modulus,
                         std::function<double(const meshes::Rubber&)> wanted) {
  return {name, {"run press"}, [=](const Evidence& run) {
            return relative_error(run.press().moduli.*modulus, wanted(run.rubber()));
          }};
}

/// Of a grasp's number against another one.
RunMeasure grasp_error(const char* name, double GraspSummary::*number,
                       double GraspSummary::*wanted) {
  return {name, {"grasp"}, [=](const Evidence& run) {
            return relative_error(run.grasp().*number, run.grasp().*wanted);
          }};
}

/// Of a contact that is drawn.
RunMeasure of_contact(const char* name, std::function<double(const ContactErrors&)> take) {
  return {
      name, {"drawn"}, [take](const Evidence& run) { return std::abs(take(run.result.contact)); }};
}

/// The largest of presses that a fit was not shown; none where one is not foretold.
RunMeasure of_held_back(const char* name,
                        std::function<double(const calibration::PredictedEntry&)> take) {
  return {name, {"fit"}, [take](const Evidence& run) {
            std::vector<double> values;
            for (const calibration::PredictedEntry& press : run.result.found.predicted)
              values.push_back(take(press));
            return largest(values);
          }};
}

/// How far the case's Poisson's ratio lies outside of the interval from displacements; 0 inside.
double ratio_outside(const Evidence& run) {
  const calibration::DisplacementFitFile& fit = run.result.ratio;
  const double truth = run.rubber().poissons_ratio();
  if (std::isnan(fit.poissons_ratio)) return meshes::unknown;
  return std::max({fit.lower - truth, truth - fit.upper, 0.0});
}

using calibration::DisplacementDistance;

/// Of a press whose displacements were measured.
RunMeasure of_displacements(const char* name,
                            std::function<double(const DisplacementComparison&)> take) {
  return {name, {"displaced"}, [take](const Evidence& run) {
            const DisplacementComparison& found = run.result.displacements;
            return found.empty() ? meshes::unknown : take(found);
          }};
}

auto rms_of(std::vector<DisplacementDistance> DisplacementComparison::*samples) {
  return [samples](const DisplacementComparison& found) {
    return largest_of_samples(found.*samples, &DisplacementDistance::rms);
  };
}

std::vector<RunMeasure> all_measures() {
  using R = const Evidence&;
  using lattice::TraceRow;
  using meshes::Rubber;
  std::vector<RunMeasure> all = {
      {"failed_checks", {"run verification"}, failed_checks},
      {"hookean_error", {"run cubes"}, cube_error},
      {"youngs_modulus_error", {"run press"}, youngs_modulus_error},
      modulus_error("shear_modulus_error", &ModuliEntry::G,
                    [](const Rubber& r) { return r.shear_modulus; }),
      modulus_error("bulk_modulus_error", &ModuliEntry::K,
                    [](const Rubber& r) { return r.bulk_modulus(); }),
      {"poissons_ratio_error",
       {"run press"},
       [](R run) { return std::abs(run.press().moduli.nu_100 - run.rubber().poissons_ratio()); }},
      {"max_force_error", {"run press"}, [](R run) { return largest(run.result.forces.error); }},
      {"l2_force_error", {"run press"}, [](R run) { return run.result.forces.l2_error; }},
      of_tracking("speed_deviation", &TrackingEntry::speed_deviation),
      of_tracking("speed_deviation_at_touch", &TrackingEntry::speed_deviation_at_touch),
      of_tracking("tilt_deg", &TrackingEntry::tilt_deg),
      {"momentum_defect",
       {"run press", "press"},
       [](R run) { return run.press().momentum_defect; }},
      {"force_overshoot",
       {"press"},
       [](R run) { return report::force_overshoot(run.rows<TraceRow>("trace.csv")); }},
      {"mode_switches",
       {"press"},
       [](R run) { return report::mode_switches(run.rows<TraceRow>("trace.csv")); }},
      {"force_error", {"beside continuum"}, [](R run) { return largest(run.result.forces.error); }},
      {"change", {"beside press"}, [](R run) { return largest(run.result.change.error); }},
      {"worst_error",
       {"variant", "prediction"},
       [](R run) { return largest(run.result.forces.error); }},
      {"hold_error", {"variant"}, hold_error},
      {"later_error", {"variant"}, later_error},
      {"loop_error", {"variant"}, [](R run) { return std::abs(run.result.forces.loop_error); }},
      of_contact("pressure_error", [](const ContactErrors& e) { return e.field.pressure_l2; }),
      of_contact("shear_error", [](const ContactErrors& e) { return e.field.shear_l2; }),
      of_contact("peak_error", [](const ContactErrors& e) { return e.field.peak; }),
      of_contact("radius_error", [](const ContactErrors& e) { return e.field.radius; }),
      of_contact("lateral_error", [](const ContactErrors& e) { return e.lateral; }),
      of_contact("torque_error", [](const ContactErrors& e) { return e.torque; }),
      of_contact("stick_radius_error", [](const ContactErrors& e) { return e.stick_radius; }),
      of_contact("taxel_error", [](const ContactErrors& e) { return e.taxels; }),
      of_contact("skin_force_error", [](const ContactErrors& e) { return e.skin_force; }),
      of_contact("hertz_error", [](const ContactErrors& e) { return e.hertz; }),
      {"poissons_ratio_outside", {"run displacements"}, ratio_outside},
      of_displacements("displacement_rms", rms_of(&DisplacementComparison::press)),
      of_displacements("displacement_largest",
                       [](const DisplacementComparison& found) {
                         return largest_of_samples(found.press, &DisplacementDistance::largest);
                       }),
      of_displacements("continuum_displacement_rms", rms_of(&DisplacementComparison::reference)),
      of_displacements("displacement_excess", displacement_excess),
      of_displacements("displacement_over_scatter", displacement_over_scatter),
      {"held", {"grasp"}, [](R run) { return is_held(run) ? 1.0 : 0.0; }},
      {"lost", {"grasp"}, [](R run) { return is_held(run) ? 0.0 : 1.0; }},
      {"surplus",
       {"grasp"},
       [](R run) { return run.grasp().wanted_force / run.grasp().least_force - 1.0; }},
      grasp_error("slip_error", &GraspSummary::slip_ratio, &GraspSummary::friction),
      grasp_error("sliding_error", &GraspSummary::sliding_ratio, &GraspSummary::friction),
      // Where the grip does not fall, the force of slip is the one that was asked for.
      {"slip_force_error",
       {"grasp"},
       [](R run) {
         return is_held(run)
                    ? relative_error(run.grasp().slip_force, run.grasp().least_force_at_rest)
                    : meshes::unknown;
       }},
      {"load_error", {"grasp"}, [](R run) { return relative_error(run.grasp().held_load, 1.0); }},
      {"momentum_defect", {"grasp"}, [](R run) { return run.grasp().momentum_defect; }},
      of_laws("fit_error", "fit", [](const LawTestEntry& test) { return test.rms_relative; }),
      of_laws("predicted_error", "predict",
              [](const LawTestEntry& test) { return test.rms_relative; }),
      of_laws("outside", "predict", [](const LawTestEntry& test) { return 1.0 - test.within; }),
      {"squares_error", {"material"}, squares_error},
      {"end_ratio", {"material"}, end_ratio},
      {"open_directions", {"fit"}, open_directions},
      {"told_apart", {"fit"}, told_apart},
      {"fit_probability", {"fit"}, [](R run) { return run.result.found.chi_square_probability; }},
      of_held_back("predicted_error",
                   [](const calibration::PredictedEntry& press) { return press.rms_relative; }),
      of_held_back("outside",
                   [](const calibration::PredictedEntry& press) {
                     return press.failure.empty() ? (press.is_within() ? 0.0 : 1.0)
                                                  : meshes::unknown;
                   }),
      suspects("rig_unnamed", 1, {"touch_offset", "compliance"}),
      suspects("strain_unnamed", told_suspects, {"finite strain"}),
      suspects("relaxation_unnamed", told_suspects, {"relaxation"}),
      suspects("contact_unnamed", told_suspects, {"sticking", "slip"}),
      {"claims_certainty", {"fit"}, [](R run) {
         const double open = open_directions(run);
         return std::isnan(open) ? open : open > 0.0 ? 0.0 : 1.0;
       }}};
  // What a fit's parameter should be: the case's own rubber.
  const std::pair<std::string, double (*)(const Rubber&)> parameters[] = {
      {"youngs_modulus", [](const Rubber& r) { return r.youngs_modulus; }},
      {"modulus", [](const Rubber& r) { return r.youngs_modulus; }},
      {"shear_modulus", [](const Rubber& r) { return r.shear_modulus; }},
      {"lame_shear", [](const Rubber& r) { return r.shear_modulus; }},
      {"lambda", [](const Rubber& r) { return r.lame_lambda(); }},
      {"retardation_time", [](const Rubber& r) { return r.retardation_time; }}};
  for (const auto& [name, truth] : parameters) {
    all.push_back({name + "_error", {"fit"}, [name, truth](R run) {
                     const double estimate = parameter(run, name).estimate;
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

Measures measures_of_run(const Case& study_case, const RunResult& result, const fs::path& place) {
  Measures taken;
  const CaseRun& run = *result.run;
  if ((run.is("press") || run.is("grasp")) && !result.ok()) return taken;
  for (const RunMeasure& measure : meant(run)) {
    const double value = measure.take({study_case, result, place});
    if (std::isfinite(value)) taken[measure.name] = value;
  }
  return taken;
}

}  // namespace fingertip::studies::inline cases
