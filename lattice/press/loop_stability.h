/// Whether the controller sets a hand swaying with the rubber on it.
#pragma once

#include "lattice/control/control_settings.h"
#include "lattice/statics/held_vibrations.h"

namespace fingertip::lattice::inline press {

/// The fastest motion exp(rate t) of a loop.
struct LoopMotion {
  double rate = 0.0;       ///< growth [1/s]; negative: all motions die away
  double frequency = 0.0;  ///< [Hz]
};

/// Of the sampled loop (README of control/): Pid of `servo` at the endpoint of a hand of this
/// inertia, commands held over a period and `latency` [s] late in all, on rubber that nothing
/// touches, whose vibrations are damped as `retardation_time` [s] has it. Exact for these
/// vibrations; limits of actuators are not in it.
LoopMotion loop_motion(const Matrix6& hand, const HeldVibrations& rubber, double retardation_time,
                       const PidSettings& servo, double latency);

/// largest_ratio r up to which rubber of whatever stiffness holds still. The tip's wrench is fed
/// forward a delay D late, beside gains for the bare hand (poles at -w):
///   stiff rubber, F = -r x'', D = period + latency: (s + w)³ + r D s⁴ = 0, which is unstable from
///   r D w = 8/9 on, at sqrt(3) w;
///   rubber that swings with nu, D = period/2 + latency: delay and servo together make its
///   oscillation grow at -½ nu² r D c³ (4 c³ - 3 c), c = nu/sqrt(nu² + w²), at most r D w²/8 where
///   nu = w, while its own damping is ½ w² retardation_time there. Above sqrt(3) w the delay damps.
/// Less than either, for the filter of the derivative delays, too.
double harmless_ratio(const PidSettings& servo, double latency, double retardation_time);

}  // namespace fingertip::lattice::inline press
