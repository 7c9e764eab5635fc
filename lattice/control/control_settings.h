/// Settings of the controllers.
#pragma once

#include <functional>
#include <vector>

#include "meshes/base/errors.h"

namespace fingertip::lattice::inline control {

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

  std::vector<meshes::Violation> violations() const;
};

/// Stiffness of the contact, dF/d(indentation) [N/m], at an indentation [m].
using StiffnessSchedule = std::function<double(double indentation)>;

/// Of the adaptive PID. None of these is a gain: the gains follow from what the relay finds.
struct AdaptiveSettings {
  /// Largest |1/(1 + L)| of the tuned loop over all frequencies, 1.2 to 3. 2 leaves a gain margin
  /// of at least 2 and a phase margin of at least 29 degrees (Astrom & Hagglund 2006, section 4.6).
  double sensitivity = 2.0;
  bool relay = true;  ///< whether a relay experiment tunes the loop; if not: half a period's delay
  bool estimate = true;         ///< whether stiffness and damping are estimated
  double memory = 0.010;        ///< time constant of forgetting [s], > 0
  double force_noise = 1e-4;    ///< of the force that motion and command imply [N], > 0
  StiffnessSchedule stiffness;  ///< known beforehand; may be empty

  std::vector<meshes::Violation> violations() const;
};

/// Of force control along the plane's normal, alone or after an approach.
struct ForceSettings {
  double force = 0.1;      ///< of the contact to be held [N], > 0
  double bandwidth = 5.0;  ///< of the force's closed loop [Hz], > 0, below a tenth of the servo's
  double touch_force = 0.01;     ///< contact is assumed above it [N], > 0 ...
  double release_force = 0.004;  ///< ... and lost below this one [N], >= 0, less than touch_force
  double confirmation = 0.003;   ///< for how long either must last [s], >= 0
  double dwell = 0.050;  ///< least time in force control before contact can be lost [s], >= 0
  StiffnessSchedule stiffness;  ///< known beforehand; estimated when empty

  std::vector<meshes::Violation> violations() const;
};

}  // namespace fingertip::lattice::inline control
