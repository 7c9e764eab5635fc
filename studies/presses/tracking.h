/// How well the rod kept its speed and orientation, or the contact force, during a press under the
/// controller.
#pragma once

#include <vector>

#include "lattice/press/press.h"
#include "studies/files/press_summary.h"

namespace fingertip::studies::inline presses {

inline constexpr double settling_time = 0.050;  ///< [s]
inline constexpr double touch_time = 0.020;     ///< [s]
inline constexpr double held_time = 0.100;      ///< [s]

/// Of a trace, NaN where it has no row to judge. Of speed, while the controller does not control
/// the contact force instead: the largest |speed - command| / (largest |command|), without
/// settling_time after the start, apart within touch_time of the first touch. Of force, where a
/// press ends while the controller controls it: over its last held_time, or what there is of that,
/// the force wanted at the end, the mean of what acted and the largest |force - wanted| / wanted.
/// `first_touch` [s]: NaN when the plane was not reached.
TrackingEntry measure_tracking(const std::vector<lattice::TraceRow>& trace, double first_touch);

}  // namespace fingertip::studies::inline presses
