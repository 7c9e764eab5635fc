/// How well the rod kept its speed and orientation, or the contact force, during a press under the
/// controller.
#pragma once

#include <vector>

#include "lattice/press/press.h"

namespace fingertip::studies::inline presses {

/// Largest deviations over a trace, of speed while the controller does not control the contact
/// force instead; NaN where the trace has no row to judge.
struct Tracking {
  /// |speed - command| / (largest |command|) from 50 ms after the start, without the first 20 ms
  /// after first touch; dimensionless.
  double speed_deviation = meshes::unknown;
  double speed_deviation_at_touch = meshes::unknown;  ///< the same within those 20 ms
  double tilt = meshes::unknown;                      ///< over the whole press [rad]

  /// Of a press that ends while the controller controls the contact force, over its last 100 ms or
  /// what there is of them in that mode: the force wanted at the end and the mean of what acted
  /// [N], and the largest |force - wanted| / wanted.
  double wanted_force = meshes::unknown;
  double held_force = meshes::unknown;
  double force_deviation = meshes::unknown;
};

inline constexpr double settling_time = 0.050;  ///< [s]
inline constexpr double touch_time = 0.020;     ///< [s]
inline constexpr double held_time = 0.100;      ///< [s]

/// `first_touch` [s]; NaN when the plane was not reached.
Tracking measure_tracking(const std::vector<lattice::TraceRow>& trace, double first_touch);

}  // namespace fingertip::studies::inline presses
