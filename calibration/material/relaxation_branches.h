/// Branches of a relaxation: over a step in time, and those that data say nothing of.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "meshes/rubber/relaxation.h"

namespace fingertip::calibration::inline material {

/// Of a step in time in which the stress after long times s goes as the parabola through its start,
/// middle and end, a branch's stress h (meshes/rubber/relaxation.h, b = 1) goes exactly to
///   decay h + gain (s_end - s_start) + 4 bend (s_end - 2 s_middle + s_start)
/// `..._slope` are tau times the derivatives by tau, and minus the duration times those by it.
struct PronyMoments {
  double decay, gain, bend, decay_slope, gain_slope, bend_slope;

  PronyMoments(double duration, double tau) {
    const double x = duration / tau;
    const meshes::PronyRecursion step(duration, tau);
    decay = step.decay;
    gain = step.gain;
    decay_slope = x * decay;
    gain_slope = gain - decay;
    if (x > 0.5) {
      bend = (0.5 * (1.0 + decay) - gain) / x;
      bend_slope = 0.5 * decay + (decay - gain) / x + bend;
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

/// A sentence for each branch faster or slower than the `times` that are observed [s].
std::vector<std::string> open_branches(const meshes::Relaxation& relaxation,
                                       const std::array<double, 2>& times);

}  // namespace fingertip::calibration::inline material
