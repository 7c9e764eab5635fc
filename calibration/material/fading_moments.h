/// A branch of a relaxation over a step in time.
#pragma once

#include "meshes/rubber/relaxation.h"

namespace fingertip::calibration::inline material {

/// Of a step in time in which the stress after long times s goes as the parabola through its start,
/// middle and end, a branch's stress h (meshes/rubber/relaxation.h, b = 1) goes exactly to
///   keep h + gain (s_end - s_start) + 4 bend (s_end - 2 s_middle + s_start)
/// `..._slope` are tau times the derivatives by tau, and minus the duration times those by it.
struct FadingMoments {
  double keep, gain, bend, keep_slope, gain_slope, bend_slope;

  FadingMoments(double duration, double tau) {
    const double x = duration / tau;
    const meshes::PronyRecursion fading(duration, tau);
    keep = fading.decay;
    gain = fading.gain;
    keep_slope = x * keep;
    gain_slope = gain - keep;
    if (x > 0.5) {
      bend = (0.5 * (1.0 + keep) - gain) / x;
      bend_slope = 0.5 * keep + (keep - gain) / x + bend;
      return;
    }
    // sum of (-x)^n (n - 1)/(2 (n + 1)!) over x: the closed form cancels.
    bend = bend_slope = 0.0;
    double power = x;  // x^(n - 1)
    double factorial = 6.0;
    for (int n = 2; n < 16; ++n) {
      const double term = (n % 2 == 0 ? 0.5 : -0.5) * (n - 1) * power / factorial;
      bend += term;
      bend_slope -= (n - 1) * term;
      power *= x;
      factorial *= n + 2;
    }
  }
};

}  // namespace fingertip::calibration::inline material
