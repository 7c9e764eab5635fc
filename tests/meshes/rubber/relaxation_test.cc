#include "meshes/rubber/relaxation.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace fingertip::meshes;

namespace {

const Relaxation two{{{0.3, 0.01}, {0.2, 1.0}}, true};

TEST(Relaxation, ModuliGoFromThatAtOnceToThatAfterLongTimes) {
  EXPECT_NEAR(two.instantaneous_ratio(), 2.0, 1e-15);
  EXPECT_NEAR(two.modulus(0.0), two.instantaneous_ratio(), 1e-15);
  EXPECT_NEAR(two.modulus(100.0), 1.0, 1e-15);
  EXPECT_NEAR(two.storage(0.0), 1.0, 1e-15);
  EXPECT_NEAR(two.storage(1e9), 2.0, 1e-12);
  EXPECT_NEAR(Relaxation().modulus(0.0), 1.0, 0.0);
}

// G'(w) + i G''(w) = i w times the one-sided Fourier transform of G(t); the part that stays is 1.
TEST(Relaxation, StorageAndLossAreTheTransformOfTheModulus) {
  for (const double w : {0.1, 3.0, 50.0, 700.0}) {
    double storage = 1.0, loss = 0.0;
    const double step = 1e-4 / std::max(1.0, w / 10.0);
    for (double t = 0.5 * step; t < 12.0; t += step) {
      storage += step * w * std::sin(w * t) * (two.modulus(t) - 1.0);
      loss += step * w * std::cos(w * t) * (two.modulus(t) - 1.0);
    }
    EXPECT_NEAR(two.storage(w), storage, 1e-4) << w;
    EXPECT_NEAR(two.loss(w), loss, 1e-4) << w;
  }
}

// dh/dt + h/tau = b ds/dt by many small steps against one.
TEST(Relaxation, FadingIsExactForAConstantRate) {
  const double time = 0.2, rate = 3.0, duration = 0.5;
  double h = 1.7;
  const PronyRecursion fading(duration, time);
  const double exact = fading.decay * h + fading.gain * rate * duration;
  constexpr int steps = 200000;
  for (int i = 0; i < steps; ++i) {
    const double dt = duration / steps, middle = h + 0.5 * dt * (rate - h / time);
    h += dt * (rate - middle / time);
  }
  EXPECT_NEAR(h, exact, 1e-10);
  EXPECT_EQ(PronyRecursion(0.0, time).decay, 1.0);
  EXPECT_EQ(PronyRecursion(0.0, time).gain, 1.0);
  EXPECT_NEAR(PronyRecursion(1e-9, 1.0).gain, 1.0 - 0.5e-9, 1e-15);
}

TEST(Relaxation, RefusesSharesAndTimesThatLeaveNothing) {
  EXPECT_TRUE(two.violations().empty());
  EXPECT_EQ((Relaxation{{{0.6, 0.1}, {0.4, 1.0}}}.violations().size()), 1u);
  EXPECT_EQ((Relaxation{{{-0.1, 0.1}}}.violations().size()), 1u);
  EXPECT_EQ((Relaxation{{{0.1, 0.0}}}.violations().size()), 1u);
  EXPECT_EQ((Relaxation{{{std::nan(""), 1.0}}}.violations().size()), 2u);
}

}  // namespace
