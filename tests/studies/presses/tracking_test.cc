#include "studies/presses/tracking.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

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
  const TrackingEntry tracking = measure_tracking(trace, 0.070);
  EXPECT_NEAR(tracking.speed_deviation_at_touch, 0.1, 1e-12);
  EXPECT_NEAR(tracking.speed_deviation, 0.01, 1e-12);
  EXPECT_DOUBLE_EQ(tracking.tilt_deg, 0.001 * 180.0 / std::numbers::pi);
}

TEST(Tracking, WithoutTouchEverythingAfterTheStartCounts) {
  auto trace = steady_trace();
  trace[75].speed = 0.009;
  const TrackingEntry tracking = measure_tracking(trace, std::nan(""));
  EXPECT_NEAR(tracking.speed_deviation, 0.1, 1e-12);
  EXPECT_TRUE(std::isnan(tracking.speed_deviation_at_touch));
}

TEST(Tracking, AnEmptyTraceSaysNothing) {
  EXPECT_TRUE(std::isnan(measure_tracking({}, 0.0).speed_deviation));
}

TEST(Tracking, TellsTheForceThatIsHeldAtTheEnd) {
  auto trace = steady_trace();
  for (std::size_t n = 40; n < trace.size(); ++n) {
    trace[n].force_mode = true;
    trace[n].wanted_force = 0.1;
    trace[n].normal_force = n % 2 == 0 ? 0.102 : 0.098;
  }
  trace[41].normal_force = 0.2;  // settling, 59 ms before the end
  TrackingEntry tracking = measure_tracking(trace, 0.040);
  EXPECT_NEAR(tracking.force_deviation, 1.0, 1e-12) << "the last 100 ms hold all of it";
  std::vector<fingertip::lattice::TraceRow> longer;
  for (std::size_t n = 0; n < 200; ++n) {
    longer.push_back(trace[std::min<std::size_t>(n, 99 + n % 2)]);
    longer.back().time = 1e-3 * double(n);
  }
  tracking = measure_tracking(longer, 0.040);
  EXPECT_NEAR(tracking.force_deviation, 0.02, 1e-12);
  EXPECT_NEAR(tracking.held_force, 0.1, 1e-3);
  EXPECT_EQ(tracking.wanted_force, 0.1);
  longer.back().force_mode = false;
  EXPECT_TRUE(std::isnan(measure_tracking(longer, 0.040).held_force));
}

TEST(Tracking, SpeedDoesNotCountWhileTheForceIsControlled) {
  auto trace = steady_trace();
  for (std::size_t n = 80; n < trace.size(); ++n) {
    trace[n].speed = 0.0;
    trace[n].force_mode = true;
  }
  EXPECT_LT(measure_tracking(trace, 0.070).speed_deviation, 1e-12);
}
