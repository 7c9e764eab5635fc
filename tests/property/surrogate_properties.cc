// Smooth curves through random forces: rising, covered by their band, whatever the forces do.
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>

#include "calibration/surrogate/surrogate.h"

using namespace fingertip::calibration;

namespace {

double uniform(double from, double to) {
  return from + (to - from) * 1e-9 * *rc::gen::inRange(0, 1000000001);
}

/// Depths and forces over many decades; rising, or not even that.
std::vector<SurrogateSample> random_samples(bool rising) {
  const int count = *rc::gen::inRange(5, 60);
  const double depth = std::pow(10.0, uniform(-5.0, 1.0)),
               most = std::pow(10.0, uniform(-6.0, 6.0));
  std::vector<SurrogateSample> samples;
  double indentation = 0.0, force = 0.0;
  for (int i = 0; i < count; ++i) {
    indentation += depth * std::pow(10.0, uniform(-4.0, 0.0));
    const double step = most * std::pow(10.0, uniform(-6.0, 0.0));
    force = rising ? force + step : step;
    samples.push_back({indentation, force, uniform(0.0, 0.1) * force});
  }
  return samples;
}

void expect_rising_and_covered(bool rising) {
  const std::vector<SurrogateSample> samples = random_samples(rising);
  const Surrogate curve = fit_surrogate(samples);
  RC_ASSERT(curve.force(0.0) == 0.0);
  double before = 0.0;
  for (int i = 1; i <= 300; ++i) {
    const double d = curve.depth() * i / 300.0;
    RC_ASSERT(curve.force(d) > before);
    RC_ASSERT(curve.stiffness(d) > 0.0);
    before = curve.force(d);
  }
  for (const SurrogateSample& sample : samples) {
    const double needed =
        std::abs(curve.force(sample.indentation) - sample.force) + 1.95 * sample.deviation;
    RC_ASSERT(curve.band(sample.indentation) >=
              needed * (1.0 - 1e-9) - 1e-12 * curve.force(curve.depth()));
  }
}

}  // namespace

int main() {
  bool ok = rc::check("rising forces", [] { expect_rising_and_covered(true); });
  ok &= rc::check("any positive forces", [] { expect_rising_and_covered(false); });
  return ok ? 0 : 1;
}
