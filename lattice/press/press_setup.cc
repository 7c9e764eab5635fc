#include "lattice/press/press_setup.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iomanip>
#include <sstream>

#include "lattice/model/constants.h"
#include "lattice/model/rod.h"
#include "lattice/press/loop_stability.h"
#include "lattice/statics/cut_lattice.h"
#include "meshes/base/files.h"
#include "meshes/press/press_motion.h"

namespace fingertip::lattice::inline press {

using meshes::Violation;

namespace {

/// What a sway grows by during a press that holds still enough, as an exponent.
const double tolerated_growth = std::log(100.0);
constexpr int cells_per_radius = 6;  // of the coarse lattice

bool positive(double value) {
  return std::isfinite(value) && value > 0.0;
}

/// The rubber as it answers at its own frequencies, with its damping as one time.
double as_at_its_frequencies(const meshes::Rubber& rubber, HeldVibrations& vibrations) {
  if (rubber.relaxation.empty()) return rubber.retardation_time;
  double damping = 0.0;
  for (double& square : vibrations.squares) {
    const double frequency = std::sqrt(square), storage = rubber.relaxation.storage(frequency);
    if (damping == 0.0)  // of the lowest: the others are damped more than by it
      damping = rubber.relaxation.loss(frequency) / (frequency * storage);
    square *= storage;
  }
  return rubber.retardation_time + damping;
}

/// None where the setup's own spacing will not do either.
std::optional<LatticeBody> coarse_body(const PressSetup& setup) {
  const double own = setup.lattice.spacing;
  for (const double spacing : {std::max(own, setup.geometry.tip_radius / cells_per_radius), own}) {
    LatticeSettings coarse;
    coarse.spacing = spacing;
    coarse.constants = hookean_constants(setup.rubber, spacing);
    if (coarse.violations(setup.geometry, setup.rubber).empty())
      return build_cut_tip(setup.geometry, setup.rubber, coarse, 1);
  }
  return std::nullopt;
}

/// The smallest x between `bad` and `good` for which `holds`, to a fiftieth of itself.
double boundary(double bad, double good, const std::function<bool(double)>& holds) {
  while (std::abs(good / bad - 1.0) > 0.02) {
    const double middle = std::sqrt(bad * good);
    (holds(middle) ? good : bad) = middle;
  }
  return good;
}

/// To two digits, away from zero if positive, toward it if negative.
double rounded_up(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 1.0);
  return std::ceil(value / unit) * unit;
}

void add_rod(std::vector<Violation>& found, const RodSettings& rod) {
  if (positive(rod.density)) return;
  found.push_back({"rod.density", meshes::to_text(rod.density) + " kg/m^3",
                   "the rod's density must be finite and positive", "aluminium has 2700"});
}

/// The controller scales its gains with the bare rod and answers the tip's pull a period late: with
/// a rod much lighter than the tip that loop is unstable (control/README.md).
void add_light_rod(std::vector<Violation>& found, const PressSetup& setup) {
  const bool known = positive(setup.rod.density) && setup.geometry.violations().empty() &&
                     setup.rubber.violations().empty();
  if (!known || setup.protocol.mode != meshes::DriveMode::pid) return;
  const std::string density = meshes::to_text(setup.rod.density) + " kg/m^3";
  const double tip_mass = setup.rubber.density * setup.geometry.tip_volume();
  if (rod_body(setup.geometry, setup.rod).mass < tip_mass) {
    found.push_back({"rod.density", density,
                     "under the controller the rod must weigh at least as much as the rubber (" +
                         meshes::to_text(tip_mass) + " kg), or the loop is unstable",
                     "take a denser or longer rod, or press.mode = quasi-static"});
  }
}

/// Lighter than the rubber only where it turns: the same loop, in other motions.
void add_swaying_hand(std::vector<Violation>& found, const PressSetup& setup) {
  if (!positive(setup.rod.density) || !setup.geometry.violations().empty() ||
      !setup.rubber.violations().empty())
    return;
  const std::optional<SwayingHand> sways = swaying_hand(setup);
  if (!sways) return;
  std::ostringstream rule;
  rule << std::setprecision(2) << "under the controller the hand would sway at " << sways->frequency
       << " Hz, a hundred times as far every " << std::log(100.0) / sways->rate
       << " s: in the motion that is easiest for it the rubber has " << sways->ratio
       << " times its inertia";
  std::string remedy = "take at least " + meshes::to_text(rounded_up(sways->density)) + " kg/m^3, ";
  if (sways->natural_frequency > 0.0)
    remedy += "controller.natural_frequency of at most " +
              meshes::to_text(-rounded_up(-sways->natural_frequency)) + " Hz, ";
  remedy += "or press.mode = quasi-static";
  found.push_back(
      {"rod.density", meshes::to_text(setup.rod.density) + " kg/m^3", rule.str(), remedy});
}

void add_adaptive_steps(std::vector<Violation>& found, const PressSetup& setup) {
  if (!is_adaptive(setup.integrator)) return;
  const std::string integrator(name(setup.integrator));
  if (setup.lattice.model == ModelKind::published) {
    found.push_back({"run.integrator", integrator,
                     "the published lattice stops particles at touch from one step to the next: "
                     "neither an error nor an energy of a step can be kept small",
                     "take symplectic-euler or explicit-euler, or another model"});
  }
  if (setup.integrator == Integrator::energy_controlled &&
      setup.protocol.contact == meshes::ContactMode::coulomb) {
    found.push_back({"run.integrator", integrator,
                     "what slip dissipates is not part of the energy balance",
                     "take another integrator, or stick or frictionless contact"});
  }
}

void add_step_control(std::vector<Violation>& found, const PressSetup& setup) {
  const auto below_one = [](double value) { return positive(value) && value < 1.0; };
  if (!below_one(setup.tolerance)) {
    found.push_back({"run.tolerance", meshes::to_text(setup.tolerance),
                     "the tolerance of runge-kutta must lie between 0 and 1", "1e-6 is usual"});
  }
  if (!below_one(setup.energy_bound)) {
    found.push_back({"run.energy_bound", meshes::to_text(setup.energy_bound),
                     "the bound of energy-controlled steps must lie between 0 and 1",
                     "1e-7 is usual"});
  }
}

}  // namespace

namespace {

bool follow_from_rubber(const SpringConstants& own, const PressSetup& setup) {
  const SpringConstants rule = hookean_constants(setup.rubber, setup.lattice.spacing);
  const auto near = [](double a, double b, double scale) {
    return std::abs(a - b) <= 1e-9 * std::abs(scale);
  };
  return near(own.k1, rule.k1, rule.k1) && near(own.k2, rule.k2, rule.k1) &&
         near(own.k3, 0.0, rule.k1) && near(own.kappa, rule.kappa, rule.kappa);
}

/// Slopes are exact or none.
void add_slopes(std::vector<Violation>& found, const PressSetup& setup) {
  if (!setup.slopes) return;
  const auto refuse = [&](const char* rule, const char* remedy) {
    found.push_back({"press.slopes", "true", rule, remedy});
  };
  if (setup.protocol.mode != meshes::DriveMode::equilibrium)
    refuse("the slopes of a press in motion are not known", "choose press.mode = static");
  if (setup.protocol.contact == meshes::ContactMode::coulomb)
    refuse("the slopes of a press are known where it sticks or is free of friction",
           "choose press.contact = stick or frictionless");
  const bool by_rule = setup.lattice.model == ModelKind::network ||
                       (setup.lattice.model == ModelKind::hookean &&
                        follow_from_rubber(setup.lattice.constants, setup));
  if (!by_rule)
    refuse("the lattice's constants must follow from the rubber's moduli in closed form",
           "choose lattice.model = hookean or network, and lattice.constants = auto");
}

void add_relaxation(std::vector<Violation>& found, const PressSetup& setup) {
  const meshes::Relaxation& relaxation = setup.rubber.relaxation;
  if (relaxation.empty()) return;
  const auto refuse = [&](const char* rule, const char* remedy) {
    found.push_back({"rubber.relaxation", std::to_string(relaxation.branches.size()) + " branches",
                     rule, remedy});
  };
  const LatticeSettings& lattice = setup.lattice;
  const bool springs = lattice.model == ModelKind::central,
             finite = lattice.kinematics == Kinematics::finite;
  if (setup.protocol.mode == meshes::DriveMode::equilibrium)
    refuse("a lattice in equilibrium knows no time, and a rubber that relaxes depends on it",
           "take press.mode = quasi-static or pid; with rubber.relaxation = [] an equilibrium is "
           "that after long times");
  else if (lattice.model == ModelKind::published || (finite && lattice.model != ModelKind::network))
    refuse("the published lattice does not relax, and at large strain no springs do",
           "take lattice.model = hookean at small strain, network at large");
  else if (finite && setup.integrator == Integrator::energy_controlled)
    refuse("at large strain the stress that relaxes is not known by an energy",
           "take run.integrator = symplectic-euler or runge-kutta");
  else if (finite && !relaxation.bulk)
    refuse("at large strain the lattice relaxes as a whole",
           "take rubber.relaxation_bulk = true, or lattice.kinematics = small");
  else if (springs && !relaxation.bulk)
    refuse("springs have no bulk modulus of their own that could stay",
           "take lattice.model = hookean, or rubber.relaxation_bulk = true");
}

/// Of what the lattice cannot do: contact, model and integrator.
std::vector<Violation> beyond_the_model(const PressSetup& setup) {
  const meshes::PressProtocol& protocol = setup.protocol;
  std::vector<Violation> found;
  add_relaxation(found, setup);
  if (protocol.mode == meshes::DriveMode::equilibrium) return found;
  const auto not_straight = [&found](const char* key, const std::string& value,
                                     const std::string& remedy) {
    found.push_back({key, value,
                     "a moving rod goes a straight way, along the plane on the way down alone",
                     "take press.mode = static" + remedy});
  };
  if (protocol.has_twist())
    not_straight("press.twist", meshes::to_text(protocol.twist) + " rad", "");
  else if (protocol.moves_after())
    not_straight("press.lateral_path", std::string(name(protocol.lateral_path)),
                 " or press.lateral_path = diagonal");
  if (protocol.has_plane_moves())
    not_straight("press.program", std::to_string(protocol.program.size()) + " stages",
                 ", or stages that press and hold");
  const LatticeSettings& lattice = setup.lattice;
  if (lattice.model == ModelKind::published) {
    const auto straight = [&found](const char* key, double value, const char* unit) {
      if (value == 0.0) return;
      found.push_back(
          {key, meshes::to_text(value) + unit,
           "the published lattice, moving, is pressed straight along the plane's normal",
           "leave it at 0, or take another model or press.mode = static"});
    };
    straight("press.tilt", protocol.tilt, " rad");
    straight("press.lateral", protocol.lateral, " m");
    if (const auto& taxels = setup.hardware.skin.taxels; !taxels.empty())
      found.push_back({"sensor.taxels", std::to_string(taxels.size()) + " taxels",
                       "the published lattice, moving, stops particles: it knows no pressure",
                       "take another model, or press.mode = static"});
    if (protocol.goes_back() && protocol.contact == meshes::ContactMode::stick)
      found.push_back(
          {"press.program", std::to_string(protocol.program.size()) + " stages",
           "the published lattice, moving, sticks till the end, as the paper has it: on "
           "the way back the plane would pull at it",
           "take press.contact = frictionless or coulomb, press.mode = static, or "
           "another model"});
  } else if (setup.integrator == Integrator::explicit_euler) {
    found.push_back({"run.integrator", std::string(name(setup.integrator)),
                     "explicit Euler adds energy to undamped motion, and the ties of true surfaces "
                     "are undamped",
                     "take symplectic-euler; explicit-euler is for the published model"});
  }
  add_adaptive_steps(found, setup);
  const bool springs = lattice.model == ModelKind::published || lattice.model == ModelKind::central;
  const bool volume =
      lattice.model == ModelKind::hookean && lattice.kinematics == Kinematics::finite;
  if (setup.integrator == Integrator::mass_scaled && (springs || volume)) {
    found.push_back({"run.integrator", std::string(name(setup.integrator)),
                     "masses are scaled cell by cell, so the model must consist of cells: hookean "
                     "at small strain, or network",
                     "take symplectic-euler, or another model"});
  } else if (setup.integrator == Integrator::mass_scaled &&
             lattice.kinematics == Kinematics::finite &&
             setup.rubber.energy != meshes::StrainEnergy()) {
    found.push_back({"run.integrator", std::string(name(setup.integrator)),
                     "masses are scaled by a bound on the neo-Hookean law's tangent, here is " +
                         meshes::describe(setup.rubber.energy),
                     "take symplectic-euler, press.mode = static, or that law"});
  }
  return found;
}

}  // namespace

std::optional<SwayingHand> swaying_hand(const PressSetup& setup) {
  if (setup.protocol.mode != meshes::DriveMode::pid || setup.make_controller ||
      setup.lattice.model == ModelKind::published)
    return std::nullopt;
  const PidSettings& servo = setup.controller;
  const double latency = setup.hardware.sensor_latency + setup.hardware.actuator_latency;
  const Matrix6 hand = rod_body(setup.geometry, setup.rod).inertia_at_endpoint();
  const std::optional<LatticeBody> body = coarse_body(setup);
  if (!body) return std::nullopt;
  const meshes::Vector3 endpoint = setup.geometry.rod_endpoint();
  SwayingHand found;
  found.ratio = largest_ratio(rubber_inertia(*body, endpoint), hand);
  if (found.ratio <= harmless_ratio(servo, latency, setup.rubber.retardation_time))
    return std::nullopt;

  HeldVibrations rubber = held_vibrations(*body, endpoint);
  const double damping = as_at_its_frequencies(setup.rubber, rubber);
  const double lasts = setup.duration.value_or(meshes::PressMotion(setup.protocol).duration());
  const auto holds = [&](const LoopMotion& motion) {
    return motion.rate * lasts <= tolerated_growth;
  };
  const auto with_density = [&](double factor) {
    return loop_motion(factor * hand, rubber, damping, servo, latency);
  };
  const auto with_frequency = [&](double frequency) {
    PidSettings other = servo;
    other.natural_frequency = frequency;
    return loop_motion(hand, rubber, damping, other, latency);
  };
  constexpr double heaviest = 1e4;
  const LoopMotion motion = with_density(1.0);
  found.rate = motion.rate, found.frequency = motion.frequency;
  if (holds(motion) || !holds(with_density(heaviest))) return std::nullopt;
  found.density =
      setup.rod.density * boundary(1.0, heaviest, [&](double x) { return holds(with_density(x)); });
  const double slowest = 0.05 * servo.natural_frequency;
  if (holds(with_frequency(slowest)))
    found.natural_frequency = boundary(servo.natural_frequency, slowest,
                                       [&](double x) { return holds(with_frequency(x)); });
  return found;
}

std::vector<Violation> beyond_the_lattice(const PressSetup& setup) {
  std::vector<Violation> found = beyond_the_model(setup);
  add_light_rod(found, setup);
  if (found.empty()) add_swaying_hand(found, setup);
  return found;
}

std::vector<Violation> PressSetup::violations() const {
  std::vector<Violation> found = geometry.violations();
  append(found, rubber.violations());
  append(found, protocol.violations(geometry));
  append(found, beyond_the_model(*this));
  append(found, lattice.violations(geometry, rubber));
  append(found, controller.violations());
  append(found, hardware.violations());
  if (duration && !positive(*duration)) {
    found.push_back({"press.duration", meshes::to_text(*duration) + " s",
                     "the duration must be finite and positive", "or leave it out"});
  }
  add_rod(found, rod);
  if (found.empty()) add_light_rod(found, *this);
  add_slopes(found, *this);
  add_step_control(found, *this);
  if (threads < 0) {
    found.push_back({"run.threads", std::to_string(threads),
                     "the number of threads must not be negative", "0 takes what is fastest"});
  }
  if (found.empty()) add_swaying_hand(found, *this);
  return found;
}

}  // namespace fingertip::lattice::inline press
