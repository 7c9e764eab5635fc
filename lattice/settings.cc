#include "lattice/settings.h"

#include <cmath>

#include "lattice/cells/cut_tip.h"
#include "lattice/rod.h"
#include "meshes/files.h"

namespace fingertip::lattice {

using meshes::Violation;

std::string_view name(Integrator integrator) {
  switch (integrator) {
    case Integrator::symplectic_euler: return "symplectic-euler";
    case Integrator::explicit_euler: return "explicit-euler";
    case Integrator::runge_kutta: return "runge-kutta";
    case Integrator::mass_scaled: return "mass-scaled";
    case Integrator::energy_controlled: return "energy-controlled";
  }
  return {};
}

bool is_adaptive(Integrator integrator) {
  return integrator == Integrator::runge_kutta || integrator == Integrator::energy_controlled;
}

namespace {

bool positive(double value) {
  return std::isfinite(value) && value > 0.0;
}
bool not_negative(double value) {
  return std::isfinite(value) && value >= 0.0;
}

bool is_rotated(const LatticeSettings& settings) {
  return !settings.axes.isIdentity(1e-12);
}

/// Grids and rubbers that a model does not stand.
void add_model(std::vector<Violation>& found, const PressSetup& setup) {
  const LatticeSettings& l = setup.lattice;
  if (l.model == ModelKind::published && is_rotated(l))
    found.push_back({"lattice.rotation", "", "the published lattice is aligned with the rod",
                     "leave the rotation at 0, or take another model"});
  for (const Violation& violation : rotation_violations(l.axes)) found.push_back(violation);
  const double nu = setup.rubber.poissons_ratio();
  if (l.model == ModelKind::network && l.kinematics == Kinematics::finite && nu < -1e-12)
    found.push_back({"rubber.youngs_modulus", "Poisson's ratio " + meshes::to_text(nu),
                     "the network at finite strain needs Poisson's ratio >= 0: below, its energy "
                     "falls without bound as a cell collapses",
                     "take lattice.kinematics = small, or another rubber"});
  if (l.model == ModelKind::hookean && l.kinematics == Kinematics::finite &&
      l.constants.kappa < 0.0)
    found.push_back({"lattice.kinematics", "finite",
                     "hookean at finite strain needs kappa >= 0 (Poisson's ratio >= 1/4): below, a "
                     "cell gains energy by any change of volume",
                     "take the model network, or lattice.kinematics = small"});
}

/// Ties to rod and plane. Within these factors forces are those of nearly rigid or of soft ties;
/// far beyond, round-off of the ties hides what the rubber does.
void add_ties(std::vector<Violation>& found, const PressSetup& setup) {
  constexpr double least = 1e-3, most = 1e3;
  const LatticeSettings& l = setup.lattice;
  const auto within = [](double value) { return value >= least && value <= most; };
  if (!within(l.ligament_stiffness))
    found.push_back({"lattice.ligament_stiffness", meshes::to_text(l.ligament_stiffness),
                     "the factor on the bond must lie between 0.001 and 1000",
                     "1 is the standard bond"});
  if (!within(l.contact_stiffness))
    found.push_back({"lattice.contact_stiffness", meshes::to_text(l.contact_stiffness),
                     "the factor on the ties to the plane must lie between 0.001 and 1000",
                     "1 is the standard tie"});
  if (l.contact_stiffness != 1.0 && l.model == ModelKind::published)
    found.push_back({"lattice.contact_stiffness", meshes::to_text(l.contact_stiffness),
                     "only lattices with true surfaces are tied to the plane",
                     "take another model, or leave it at 1"});
  // The bond's area shrinks with the rod; a thread through a cell holds nothing.
  if (l.model != ModelKind::published && setup.geometry.rod_radius < 0.1 * l.spacing)
    found.push_back({"lattice.spacing", meshes::to_text(l.spacing) + " m",
                     "the spacing must be at most ten times the rod's radius, or the bond does not "
                     "hold the rubber",
                     "choose a finer lattice, or a thicker rod"});
}

void add_lattice(std::vector<Violation>& found, const PressSetup& setup) {
  const LatticeSettings& l = setup.lattice;
  if (!(positive(l.spacing) && l.spacing <= 0.5 * setup.geometry.thickness())) {
    found.push_back({"lattice.spacing", meshes::to_text(l.spacing) + " m",
                     "the spacing must be positive and at most (R - r)/2, two cells through the "
                     "rubber",
                     "choose a finer lattice"});
  }
  if (!(l.offset.allFinite() && l.offset.cwiseAbs().maxCoeff() <= 1.0)) {
    found.push_back({"lattice.offset", "",
                     "every component of the offset must lie between -1 and 1 spacing",
                     "shift the grid by less"});
  }
  add_model(found, setup);
  const SpringConstants& k = l.constants;
  const double needed = l.model == ModelKind::published ? k.k1 + k.k2 + k.k3 : k.k2 + k.k3;
  const bool springs = not_negative(k.k1) && not_negative(k.k2) && not_negative(k.k3) &&
                       needed > 0.0 && std::isfinite(k.kappa);
  // The network takes G and lambda from the rubber.
  if (l.model != ModelKind::network && !springs) {
    found.push_back(
        {"lattice.constants",
         "k1 " + meshes::to_text(k.k1) + ", k2 " + meshes::to_text(k.k2) + ", k3 " +
             meshes::to_text(k.k3) + " N/m",
         "spring constants must be finite and not negative, and some diagonal must resist "
         "shear",
         "use the model's closed form or a calibration"});
  }
  add_ties(found, setup);
}

void add_controller(std::vector<Violation>& found, const PidSettings& c) {
  const auto require = [&](double value, const char* key, const char* unit, const char* what) {
    if (positive(value)) return;
    found.push_back({key, meshes::to_text(value) + unit, what, "give a positive value"});
  };
  require(c.period, "controller.period", " s", "the sampling period must be finite and positive");
  require(c.natural_frequency, "controller.natural_frequency", " Hz",
          "the closed loop's natural frequency must be finite and positive");
  require(c.derivative_filter, "controller.derivative_filter", "",
          "the derivative filter's N must be finite and positive");
  if (!(c.bond_compensation >= 0.0 && c.bond_compensation <= 1.0)) {
    found.push_back({"controller.bond_compensation", meshes::to_text(c.bond_compensation),
                     "the share of the measured wrench fed forward must lie between 0 and 1",
                     "1 cancels the tip's pull on the rod, 0 leaves it to the integrator"});
  }
  if (!(c.setpoint_weight >= 0.0 && c.setpoint_weight <= 1.0)) {
    found.push_back({"controller.setpoint_weight", meshes::to_text(c.setpoint_weight),
                     "the share of the set point in the proportional part must lie between 0 and 1",
                     "1 answers a set point like an error, 0 spares the actuator"});
  }
  require(c.force_limit, "controller.force_limit", " N",
          "the actuator's force limit must be finite and positive");
  require(c.torque_limit, "controller.torque_limit", " N m",
          "the actuator's torque limit must be finite and positive");
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

/// Of what the lattice cannot do: contact, model and integrator.
std::vector<Violation> beyond_the_model(const PressSetup& setup) {
  const meshes::PressProtocol& protocol = setup.protocol;
  std::vector<Violation> found;
  if (protocol.mode == meshes::DriveMode::equilibrium) {
    if (protocol.contact == meshes::ContactMode::coulomb) {
      found.push_back({"press.contact", "coulomb",
                       "the lattice in equilibrium sticks or is free of friction",
                       "take press.mode = quasi-static or pid, where it slides, or compute "
                       "the equilibrium with `reference`"});
    }
    return found;
  }
  if (protocol.slides_after()) {
    found.push_back({"press.lateral_path", std::string(name(protocol.lateral_path)),
                     "a moving rod goes a straight way, along the plane on the way down",
                     "take press.mode = static or press.lateral_path = diagonal"});
  }
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
  }
  return found;
}

}  // namespace

std::vector<Violation> beyond_the_lattice(const PressSetup& setup) {
  std::vector<Violation> found = beyond_the_model(setup);
  add_light_rod(found, setup);
  return found;
}

std::vector<Violation> PressSetup::violations() const {
  std::vector<Violation> found = geometry.violations();
  const auto append = [&found](const std::vector<Violation>& more) {
    found.insert(found.end(), more.begin(), more.end());
  };
  append(rubber.violations());
  append(protocol.violations(geometry));
  append(beyond_the_model(*this));
  add_lattice(found, *this);
  add_controller(found, controller);
  append(hardware.violations());
  if (duration && !positive(*duration)) {
    found.push_back({"press.duration", meshes::to_text(*duration) + " s",
                     "the duration must be finite and positive", "or leave it out"});
  }
  add_rod(found, rod);
  if (found.empty()) add_light_rod(found, *this);
  add_step_control(found, *this);
  if (threads < 0) {
    found.push_back({"run.threads", std::to_string(threads),
                     "the number of threads must not be negative", "0 takes all cores"});
  }
  return found;
}

}  // namespace fingertip::lattice
