/// Everything that defines a lattice press, apart from the specimen itself.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lattice/constants.h"
#include "lattice/control/hardware.h"
#include "lattice/control/task.h"
#include "lattice/rod.h"
#include "meshes/errors.h"
#include "meshes/geometry.h"
#include "meshes/press_protocol.h"
#include "meshes/rubber.h"

namespace fingertip::lattice {

/// Time integration of x' = v, v' = f/m.
enum class Integrator {
  symplectic_euler,   ///< v first, then x with the new v; the default
  explicit_euler,     ///< as printed in the paper's Fig. 4: x with the old v, then v
  runge_kutta,        ///< explicit, of order 5, its step chosen by the estimated error
  mass_scaled,        ///< symplectic Euler with inertia against deformation, at long steps
  energy_controlled,  ///< symplectic Euler, its step chosen by the energy it gains or loses
};
std::string_view name(Integrator integrator);
/// Whether it chooses every step by what the last ones did, not by stability alone.
bool is_adaptive(Integrator integrator);

/// The lattice of the tip.
struct LatticeSettings {
  ModelKind model = ModelKind::hookean;
  Kinematics kinematics = Kinematics::small;
  double spacing = 0.01 / 12.0;                      ///< a [m], at most (R - r)/2
  meshes::Vector3 offset = meshes::Vector3::Zero();  ///< shift of the grid in units of a
  /// Columns: the grid's axes in the tip's frame, a rotation.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  SpringConstants constants;        ///< for this spacing
  double ligament_stiffness = 1.0;  ///< multiplies the stiffness of the bond to the rod
  double contact_stiffness = 1.0;   ///< multiplies the ties of true surfaces to the plane
};

/// The 6-degree-of-freedom PID at the rod's endpoint. Gains follow from the rod's inertia and a
/// triple closed-loop pole at the natural frequency (README of control/).
struct PidSettings {
  double period = 1.0e-3;           ///< sampling period, zero-order hold in between [s], > 0
  double natural_frequency = 60.0;  ///< of the closed loop with the bare rod [Hz], > 0
  double derivative_filter = 10.0;  ///< N > 0: the derivative's low-pass over the natural frequency
  double setpoint_weight = 1.0;     ///< b: share of the set point in the proportional part, 0 to 1
  double bond_compensation = 1.0;   ///< share of the measured bond wrench fed forward, 0 to 1
  double force_limit = 20.0;        ///< of the actuator, along each axis [N], > 0
  double torque_limit = 1.0;        ///< of the actuator, about each axis [N m], > 0
};

/// The complete order for one press.
struct PressSetup {
  meshes::Geometry geometry;
  meshes::Rubber rubber;
  meshes::PressProtocol protocol;
  LatticeSettings lattice;
  RodSettings rod;
  PidSettings controller;  ///< the built-in servo, and the controller unless another is made
  ControllerFactory make_controller;  ///< another one; empty: PidController on the way of the press
  /// Tells one maker from another wherever results are kept; empty with an empty maker.
  std::string controller_identity;
  /// Whether the controller is to stay on the way of the press; if not, leaving it is no failure.
  bool follows_path = true;
  HardwareSettings hardware;
  std::optional<double> duration;  ///< ends the press at this time [s], if not at its depth before
  double gravity = 0.0;            ///< toward the plane [m/s²]
  Integrator integrator = Integrator::symplectic_euler;
  std::optional<double> time_step;  ///< largest one [s]; the largest safe one when absent
  double tolerance = 1e-6;          ///< of runge_kutta, > 0 (integrators/runge_kutta.h)
  double energy_bound = 1e-7;       ///< of energy_controlled, > 0 (integrators/energy_stepper.h)
  int threads = 0;                  ///< 0: all cores. The result does not depend on it.

  /// Every broken rule of specimen, protocol, lattice, rod and controller, and what is
  /// beyond_the_lattice.
  std::vector<meshes::Violation> violations() const;
};

/// What of a valid order the lattice cannot do: Coulomb friction in equilibrium; a lateral motion
/// after the press while the rod moves; the published model, moving, is pressed straight and needs
/// an Euler step; explicit Euler is for it alone; under a controller the rod weighs at least as
/// much as the rubber.
std::vector<meshes::Violation> beyond_the_lattice(const PressSetup& setup);

}  // namespace fingertip::lattice
