/// How fast a press ran, and how far its force was off.
#pragma once

#include "lattice/press/press.h"
#include "meshes/press/press_response.h"

namespace fingertip::studies::inline presses {

/// Simulated over elapsed time; NaN where it cannot be told.
struct Pace {
  double wall = meshes::unknown;
  double processor = meshes::unknown;  ///< over the processor time of the thread that presses
};

/// Of what "the slowest 10 ms" says [s].
inline constexpr double pace_window = 0.01;

/// Of the slowest stretch of at least `window` seconds of simulated time between two rows of the
/// trace, from the first touch on.
Pace slowest_pace(const lattice::PressOutcome& outcome, double window);

/// Largest |F/F_reference - 1| at the samples of the response from `from` to `to` [m], between
/// those of the reference by monotone interpolation; NaN where one of them does not reach as far.
double worst_force_error(const meshes::PressResponse& response,
                         const meshes::PressResponse& reference, double from, double to);

}  // namespace fingertip::studies::inline presses
