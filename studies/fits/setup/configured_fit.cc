#include "studies/fits/setup/configured_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "calibration/press_fit/lattice_forward_model.h"
#include "studies/config/finger_defaults.h"
#include "studies/fits/models/continuum_model.h"
#include "studies/fits/models/fit_relaxation.h"
#include "studies/fits/models/fit_rig.h"
#include "studies/fits/models/omitted_effects.h"
#include "studies/fits/setup/fit_curves.h"
#include "studies/fits/setup/fit_parameters.h"
#include "studies/fits/setup/fit_plan.h"
#include "studies/fits/setup/fit_tolerances.h"
#include "studies/jobs/provenance.h"
#include "studies/presses/press_setup.h"

namespace fingertip::studies::inline fits::inline setup {

using calibration::FreeParameter;
using calibration::MaterialParameter;
using lattice::ModelKind;

namespace {

/// A hundredth of a standard error is close enough for a model that takes seconds to answer.
constexpr double search_tolerance = 1e-2;

/// Finite strain that adds less to the deepest force than this is not worth its cost.
constexpr double small_excess = 0.01;

using enum MaterialParameter;

void check_profile(const LoadedConfig& loaded, const FitInput& input) {
  const auto known = [&](const std::string& word) {
    return std::ranges::any_of(input.options.free, [&](const FreeParameter& free) {
      return calibration::label(free) == word;
    });
  };
  const std::vector<std::string>& names = input.profile;
  if (names.empty()) return;
  if (names.size() != 2 || names[0] == names[1] || !known(names[0]) || !known(names[1]))
    throw refused(loaded, "calibration.profile", "",
                  "a profile is drawn over two different free parameters",
                  "name two of those that are free, or none");
}

void check_data(const LoadedConfig& loaded) {
  const CalibrationSettings& settings = loaded.config.calibration;
  if (settings.problem == CalibrationProblem::curve && !settings.data.empty())
    throw refused(loaded, "calibration.data", "",
                  "the problem curve makes its data by the continuum",
                  "leave data out, or take the problem experiment");
}

/// What a model would refuse is said before the continuum runs for it.
void check_models(const LoadedConfig& loaded, const FitInput& input) {
  for (const FitCurve& curve : input.curves) {
    try {
      if (curve.kind == CurveKind::press)
        calibration::LatticeForwardModel(curve.press, parameters_of(input));
      else if (curve.kind == CurveKind::continuum)
        continuum_model(curve.continuum, parameters_of(input), "", {});
    } catch (const meshes::InvalidInput& error) {
      std::vector<meshes::Violation> broken = error.violations();
      for (meshes::Violation& violation : broken)
        if (violation.key == "parameters") violation.key = "calibration.parameters";
      throw loaded.locate(broken);
    }
  }
}

/// The lattice is needed where constants are sought or the press is the lattice's.
lattice::PressSetup base_of(const LoadedConfig& loaded) {
  return press_setup(with_sets(loaded, {"press.mode=static", "press.slopes=false"}),
                     lattice_of_fit(loaded));
}

/// Presses that are planned have no times.
void check_plan(const LoadedConfig& loaded, const FitInput& input) {
  if (!input.branches.empty())
    throw refused(loaded, "rubber.relaxation", "",
                  "a plan is one of presses in equilibrium, and a rubber that relaxes depends on "
                  "time",
                  "plan with rubber.relaxation = [], the rubber after long times");
}

void check_model(const LoadedConfig& loaded) {
  const CalibrationSettings& settings = loaded.config.calibration;
  const ModelKind model = loaded.config.press.lattice.model;
  const bool by_press = settings.problem == CalibrationProblem::curve ||
                        settings.problem == CalibrationProblem::experiment;
  if (by_press && model == ModelKind::published)
    throw refused(loaded, "lattice.model", "published",
                  "the published model has a rule for its constants and is not calibrated",
                  "calibrate central, hookean or network");
}

/// Forces are proportional to a modulus at held Poisson's ratio: to ask for others costs nothing.
bool has_profile_intervals(const CalibrationSettings& wanted, const FitInput& input) {
  if (wanted.problem != CalibrationProblem::experiment) return false;
  if (wanted.intervals != IntervalKind::automatic) return wanted.intervals == IntervalKind::profile;
  return asks_one_press(input);
}

/// Whether a lattice answers for it, pressed anew for every set of parameters.
bool is_lattice(const FitCurve& curve) {
  return curve.kind == CurveKind::press || curve.kind == CurveKind::moving_press;
}

/// Where the presses of a fit come from.
enum class Presses { made, planned };

FitSetup assembled(const LoadedConfig& given, Presses presses,
                   const std::shared_ptr<MeasuredFiles>& files) {
  const CalibrationSettings& wanted = given.config.calibration;
  const LoadedConfig loaded = knows_relaxation(wanted) ? in_equilibrium(given) : given;
  check_model(loaded);
  check_data(loaded);
  FitSetup fit;
  fit.files = files;
  FitInput& input = fit.input;
  input.problem = wanted.problem;
  input.base = base_of(loaded);
  input.options.free = free_list(given, input.base);
  if (const auto note = held_ratio_note(given, input)) fit.notes.push_back(*note);
  if (knows_relaxation(wanted)) input.branches = branches_of(given, input.options.free);
  if (presses == Presses::planned) check_plan(given, input);
  input.options.robust_width = wanted.robust_width;
  input.options.tolerance = search_tolerance;
  input.program = "fingertip " + program_version();
  input.profile = wanted.profile;
  input.density_known = loaded.entries.at("rubber.density").given;
  input.retardation_time_known = loaded.entries.at("rubber.retardation_time").given;
  bound_poissons_ratio(loaded, input);
  const bool from_continuum =
      wanted.problem == CalibrationProblem::curve ||
      (wanted.problem == CalibrationProblem::damping && wanted.data.empty());
  if (presses == Presses::planned) {
    add_planned_curves(fit, loaded);
  } else if (from_continuum) {
    add_continuum_curves(fit, loaded);
  } else {
    add_measured_curves(fit, loaded);
  }
  start_branches(given, input);
  if (!input.branches.empty() && wanted.bias && !by_continuum(input))
    throw refused(
        given, "calibration.bias", "true",
        "the continuum beside a fit presses a rubber in equilibrium, and this one relaxes",
        "leave it out, or let the continuum answer: calibration.forward = \"continuum\"");
  check_profile(loaded, input);
  input.scale_to_data = wanted.problem == CalibrationProblem::experiment;
  input.start_ratios = start_ratios(input);
  input.profile_intervals = has_profile_intervals(wanted, input);
  check_models(loaded, input);
  // A reference ends where every force is known that well, a bar that covers 95 %.
  if (by_continuum(input)) {
    input.known_errors.push_back({"the continuum's tolerance"});
    for (FitCurve& curve : input.curves)
      curve.known_errors.emplace_back(curve.press.protocol.samples.size(),
                                      0.5 * loaded.config.reference.tolerance);
  }
  input.with_lattice_error = std::ranges::all_of(input.curves, is_lattice);
  fit.loaded = given;
  return fit;
}

/// The finite law knows these, too, and nobody chose small strain.
bool may_be_finite(const LoadedConfig& loaded, const FitInput& input) {
  const auto given = [&](const char* key) { return loaded.entries.at(key).given; };
  return !given("lattice.model") && !given("lattice.kinematics") && !given("lattice.constants") &&
         std::ranges::all_of(parameters_of(input), [](MaterialParameter parameter) {
           return calibration::is_of_the_rubber(parameter) || parameter == bond ||
                  parameter == contact;
         });
}

/// Data beyond small strain are fitted by the finite law, or what it adds to the forces counts as
/// uncertain; both are said before the fit.
FitSetup at_the_right_strain(const LoadedConfig& loaded, FitSetup fit, Presses presses,
                             const std::vector<std::vector<double>>& excess) {
  double most = 0.0, depth = 0.0;
  for (std::size_t i = 0; i < excess.size(); ++i)
    if (std::abs(excess[i].back()) > std::abs(most)) {
      most = excess[i].back();
      const lattice::PressSetup& press = fit.input.curves[i].press;
      depth = press.protocol.depth / press.geometry.thickness();
    }
  if (std::abs(most) <= small_excess) return fit;
  const std::string said = strain_words(depth, most);
  if (may_be_finite(loaded, fit.input)) {
    FitSetup finite = assembled(with_sets(loaded, {"lattice.model=network"}), presses, fit.files);
    finite.notes.push_back(said +
                           ": the finite law is fitted, lattice.model = network (small "
                           "strain on request: lattice.kinematics = small)");
    return finite;
  }
  if (loaded.entries.at("lattice.kinematics").given) {
    fit.notes.push_back(said + "; small strain is fitted as asked by lattice.kinematics");
    return fit;
  }
  fit.input.known_errors.push_back({finite_strain_error});
  for (std::size_t i = 0; i < excess.size(); ++i)
    fit.input.curves[i].known_errors.push_back(excess[i]);
  fit.notes.push_back(said +
                      ": that difference counts as an error of the model, which widens the "
                      "intervals (the finite law: lattice.model = network)");
  return fit;
}

/// How long the search may take is said before it begins.
void set_budget(const LoadedConfig& loaded, FitSetup& fit) {
  const bool costs = std::ranges::any_of(fit.input.curves, is_lattice) &&
                     !(has_presses(fit.input) && seeks_moduli_alone(fit.input));
  if (!costs && !loaded.entries.at("calibration.evaluations").given) return;
  fit.input.options.max_evaluations = loaded.config.calibration.evaluations;
  if (!costs) return;
  fit.notes.push_back(
      fmt::format("the search may do {} evaluations (calibration.evaluations), each "
                  "a press of every curve",
                  fit.input.options.max_evaluations));
}

/// What is fitted, and with it what is held back: its curves and parameters stand behind.
void hold_back(const LoadedConfig& loaded, FitSetup& fit) {
  if (fit.held_back == 0) return;
  FitInput& input = fit.input;
  input.with_held_back = std::make_shared<const FitInput>(input);
  input.curves.resize(input.curves.size() - fit.held_back);
  std::size_t parameters = material_parameters(input);
  for (const calibration::FitBranch& branch : input.branches)
    for (const calibration::FitQuantity& each : {branch.share, branch.time})
      if (each.place) parameters = std::max(parameters, std::size_t(*each.place) + 1);
  for (const FitCurve& curve : input.curves)
    for (const auto member : calibration::rig_members)
      if (const auto place = curve.travel ? (curve.travel->rig.*member).place : std::nullopt)
        parameters = std::max(parameters, std::size_t(*place) + 1);
  input.options.free.resize(parameters);
  check_profile(loaded, input);
}

/// Of the depth of a press: forces below tell little of a modulus.
constexpr double first_that_counts = 0.2;

/// Of the presses that were measured the one that needs the finest lattice, from where its forces
/// count on; `loaded` where none was measured, or the spacing is given.
LoadedConfig most_demanding(const LoadedConfig& loaded, const FitSetup& fit) {
  const std::vector<FitCurve>& curves = fit.input.curves;
  if (!loaded.config.automatic_spacing || fit.settings.size() != curves.size()) return loaded;
  std::optional<LoadedConfig> finest;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (curves[i].press.protocol.samples.empty()) continue;  // its depth is the configuration's
    const double depth = curves[i].press.protocol.samples.back();
    std::vector<std::string> sets = fit.settings[i];
    sets.push_back(samples_setting({first_that_counts * depth, depth}));
    LoadedConfig own = with_sets(loaded, sets);
    if (!finest || *own.config.spacing_divisor > *finest->config.spacing_divisor)
      finest = std::move(own);
  }
  return finest.value_or(loaded);
}

FitSetup set_up(const LoadedConfig& given, Presses presses,
                const std::shared_ptr<MeasuredFiles>& files) {
  FitSetup first = assembled(given, presses, files);
  const bool asks_lattice = lattice_of_fit(given) != LatticeUse::none;
  const LoadedConfig finest = asks_lattice ? most_demanding(given, first) : given;
  LoadedConfig loaded = given;
  if (const auto divisor = finest.config.spacing_divisor; divisor != given.config.spacing_divisor) {
    loaded = with_sets(given, {fmt::format("lattice.spacing=tip_radius/{:.0f}", *divisor)});
    first = assembled(loaded, presses, files);
  }
  const auto excess = excess_of_finite_strain(first.input);
  FitSetup fit = at_the_right_strain(loaded, std::move(first), presses, excess);
  if (fit.input.base.lattice.kinematics == lattice::Kinematics::small)
    for (std::size_t i = 0; i < excess.size(); ++i) fit.input.curves[i].finite_excess = excess[i];
  add_tolerances(loaded, fit.input);
  fit.input.contact_told = fit.contact_known;
  hold_back(loaded, fit);
  set_budget(loaded, fit);
  if (const std::string note = spacing_note(finest); asks_lattice && !note.empty())
    fit.notes.push_back(note);
  fit.input.candidates = candidates_of(
      knows_relaxation(loaded.config.calibration) ? in_equilibrium(fit.loaded) : fit.loaded, fit);
  return fit;
}

}  // namespace

std::string strain_words(double depth, double excess) {
  return fmt::format(
      "the data go to {:.0f} % of the rubber's thickness, where a neo-Hookean solid is "
      "{:.0f} % {} than small strain has it",
      100.0 * depth, 100.0 * std::abs(excess), excess < 0.0 ? "softer" : "stiffer");
}

FitSetup fit_setup(const LoadedConfig& loaded, const std::shared_ptr<MeasuredFiles>& files) {
  return set_up(loaded, Presses::made, files);
}

FitSetup plan_setup(const LoadedConfig& loaded) {
  const CalibrationProblem problem = loaded.config.calibration.problem;
  if (problem != CalibrationProblem::experiment)
    throw refused(loaded, "calibration.problem", std::string(name(problem)),
                  "a plan is one of measured presses", "take the problem experiment");
  return set_up(loaded, Presses::planned, std::make_shared<MeasuredFiles>());
}

}  // namespace fingertip::studies::inline fits::inline setup
