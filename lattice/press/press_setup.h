/// Everything that defines a lattice press, apart from the specimen itself.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lattice/control/control_settings.h"
#include "lattice/control/hardware.h"
#include "lattice/control/task.h"
#include "lattice/dynamics/integrator.h"
#include "lattice/model/lattice_settings.h"
#include "lattice/model/rod.h"
#include "meshes/base/errors.h"
#include "meshes/press/press_protocol.h"
#include "meshes/rubber/rubber.h"
#include "meshes/shape/geometry.h"

namespace fingertip::lattice::inline press {

/// All that one press needs.
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
  int threads = 0;                  ///< 0: fastest_threads, at rest one. The result does not depend
                                    ///< on it.
  bool slopes = false;   ///< of a press at rest: its normal force's by E and by Poisson's ratio
  bool symmetry = true;  ///< computes one of the parts that are mirror images of each other, where
                         ///< a moving press has such (moving_sectors)

  /// Every broken rule of specimen, protocol, lattice, rod and controller, and what is
  /// beyond_the_lattice.
  std::vector<meshes::Violation> violations() const;
};

/// What of a valid setup the lattice cannot do: Coulomb friction and relaxation in equilibrium; a
/// lateral motion after the press while the rod moves; the published model, moving, is pressed
/// straight and needs an Euler step; explicit Euler is for it alone; under a controller the rod
/// weighs at least as much as the rubber and does not sway with it (swaying_hand).
std::vector<meshes::Violation> beyond_the_lattice(const PressSetup& setup);

/// A hand that sways, and what would not.
struct SwayingHand {
  double rate = 0.0;               ///< with which its sway grows [1/s]
  double frequency = 0.0;          ///< of its sway [Hz]
  double ratio = 0.0;              ///< largest_ratio
  double density = 0.0;            ///< of the same hand that holds still [kg/m³]
  double natural_frequency = 0.0;  ///< with which it holds still [Hz]; 0: with none tried
};

/// Set if the built-in controller would make a sway of this press grow more than a hundredfold
/// while it lasts, although the bare hand's loop is stable. For valid setups. Of another controller
/// nothing is known, and the published lattice's dampers are critical: none. Stiffness, mass and
/// damping are those of the rubber at small strain, on a coarse lattice.
std::optional<SwayingHand> swaying_hand(const PressSetup& setup);

}  // namespace fingertip::lattice::inline press
