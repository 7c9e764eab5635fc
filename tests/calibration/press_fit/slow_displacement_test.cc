/// 95 % intervals of Poisson's ratio from displacements.
#include <gtest/gtest.h>

#include "tests/calibration/press_fit/displacement_draws.h"

TEST(SlowCoverage, IntervalsOfPoissonsRatioFromDisplacements) {
  const int count = displacement_draws::inside(100, 0.45, 1e-5);
  RecordProperty("inside", count);
  EXPECT_GE(count, 93);
  EXPECT_LE(count, 97);
}
