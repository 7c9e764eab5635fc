/// How well the rod kept its speed and orientation during a press under the controller.
#pragma once

#include <vector>

#include "lattice/press.h"

namespace fingertip::studies {

/// Largest deviations over a trace, of speed while the controller does not control the contact
/// force instead; NaN where the trace has no row to judge.
struct Tracking {
  /// |speed - command| / |command| from 50 ms after the start, without the first 20 ms after
  /// first touch; dimensionless.
  double speed_deviation = meshes::unknown;
  double speed_deviation_at_touch = meshes::unknown;  ///< the same within those 20 ms
  double tilt = meshes::unknown;                      ///< over the whole press [rad]
  /// Of a controller that holds a contact force at the end: that force over the last
  /// `holding_time` of force control, its mean and what it should be [N], and by how much the force
  /// exceeds the latter at most.
  double held_force = meshes::unknown, wanted_force = meshes::unknown;
  double force_overshoot = meshes::unknown;  ///< relative
};

inline constexpr double settling_time = 0.050;  ///< [s]
inline constexpr double touch_time = 0.020;     ///< [s]
inline constexpr double holding_time = 0.050;   ///< [s]

/// `first_touch` [s]; NaN when the plane was not reached.
Tracking measure_tracking(const std::vector<lattice::TraceRow>& trace, double first_touch);

}  // namespace fingertip::studies
