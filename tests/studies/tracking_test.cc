#include "studies/run/tracking.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace fingertip::studies;

namespace {

/// 100 ms at the commanded 1 cm/s, one row per millisecond.
std::vector<fingertip::lattice::TraceRow> steady_trace() {
  std::vector<fingertip::lattice::TraceRow> trace(101);
  for (std::size_t i = 0; i < trace.size(); ++i) {
    trace[i].time = 1e-3 * double(i);
    trace[i].commanded_speed = trace[i].speed = 0.01;
  }
  return trace;
}

}  // namespace

TEST(Tracking, IgnoresTheStartAndSeparatesTheTouch) {
  auto trace = steady_trace();
  trace[10].speed = 0.0;     // settling
  trace[75].speed = 0.009;   // within 20 ms after first touch
  trace[95].speed = 0.0101;  // after them
  trace[60].tilt = -0.001;
  const Tracking tracking = measure_tracking(trace, 0.070);
  EXPECT_NEAR(tracking.speed_deviation_at_touch, 0.1, 1e-12);
  EXPECT_NEAR(tracking.speed_deviation, 0.01, 1e-12);
  EXPECT_EQ(tracking.tilt, 0.001);
}

TEST(Tracking, WithoutTouchEverythingAfterTheStartCounts) {
  auto trace = steady_trace();
  trace[75].speed = 0.009;
  const Tracking tracking = measure_tracking(trace, std::nan(""));
  EXPECT_NEAR(tracking.speed_deviation, 0.1, 1e-12);
  EXPECT_TRUE(std::isnan(tracking.speed_deviation_at_touch));
}

TEST(Tracking, AnEmptyTraceSaysNothing) {
  EXPECT_TRUE(std::isnan(measure_tracking({}, 0.0).speed_deviation));
}

TEST(Tracking, SpeedDoesNotCountWhileTheForceIsControlled) {
  auto trace = steady_trace();
  for (std::size_t n = 80; n < trace.size(); ++n) {
    trace[n].speed = 0.0;
    trace[n].force_mode = true;
  }
  EXPECT_LT(measure_tracking(trace, 0.070).speed_deviation, 1e-12);
}
