#include "studies/presses/pace.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace fingertip;
using studies::slowest_pace;

namespace {

/// A trace of 1 ms periods; period i takes cost(i) seconds of wall time and half of processor time.
template <typename Cost>
lattice::PressOutcome press(int periods, double first_touch, const Cost& cost) {
  lattice::PressOutcome outcome;
  outcome.first_touch_time = first_touch;
  double wall = 0.0;
  for (int i = 0; i <= periods; ++i) {
    lattice::TraceRow row;
    row.time = 1e-3 * i;
    outcome.trace.push_back(row);
    outcome.elapsed.push_back({wall, 0.5 * wall});
    wall += cost(i);
  }
  return outcome;
}

/// F = slope * depth at ten depths to 3 mm.
meshes::PressResponse line(double slope) {
  meshes::PressResponse response;
  for (int i = 1; i <= 10; ++i) {
    meshes::PressSample sample;
    sample.indentation = 3e-4 * i;
    sample.normal_force = slope * sample.indentation;
    response.append(sample);
  }
  return response;
}

}  // namespace

TEST(Pace, EvenPeriodsHaveTheirOwnFactor) {
  const auto pace = slowest_pace(press(50, 0.0, [](int) { return 2e-3; }), 0.01);
  EXPECT_NEAR(pace.wall, 0.5, 1e-12);
  EXPECT_NEAR(pace.processor, 1.0, 1e-12);
}

TEST(Pace, TheSlowestTenPeriodsCount) {
  const auto slow = [](int i) { return i >= 20 && i < 30 ? 5e-3 : 1e-3; };
  EXPECT_NEAR(slowest_pace(press(50, 0.0, slow), 0.01).wall, 0.2, 1e-12);
  // One slow period among nine fast ones.
  const auto hiccup = [](int i) { return i == 20 ? 11e-3 : 1e-3; };
  EXPECT_NEAR(slowest_pace(press(50, 0.0, hiccup), 0.01).wall, 0.5, 1e-12);
}

TEST(Pace, WhatHappensBeforeTouchDoesNotCount) {
  const auto slow_start = [](int i) { return i < 20 ? 9e-3 : 1e-3; };
  EXPECT_NEAR(slowest_pace(press(50, 0.02, slow_start), 0.01).wall, 1.0, 1e-12);
}

TEST(Pace, UnknownWithoutTouchOrWithTooShortAPress) {
  EXPECT_TRUE(
      std::isnan(slowest_pace(press(50, meshes::unknown, [](int) { return 1e-3; }), 0.01).wall));
  EXPECT_TRUE(std::isnan(slowest_pace(press(5, 0.0, [](int) { return 1e-3; }), 0.01).wall));
}

TEST(ForceError, IsTheLargestRelativeOne) {
  EXPECT_NEAR(studies::worst_force_error(line(1.05), line(1.0), 1e-3, 3e-3), 0.05, 1e-9);
  EXPECT_NEAR(studies::worst_force_error(line(0.9), line(1.0), 1e-3, 3e-3), 0.1, 1e-9);
}

/// A dense reference interpolates nothing, a response with few samples is judged at these.
TEST(ForceError, IsTakenAtTheSamplesOfTheResponse) {
  const auto hertz = [](int samples, double factor) {
    meshes::PressResponse curve;
    for (int i = 1; i <= samples; ++i) {
      meshes::PressSample sample;
      sample.indentation = 3e-3 * i / samples;
      sample.normal_force = factor * std::pow(sample.indentation, 1.5);
      curve.append(sample);
    }
    return curve;
  };
  EXPECT_NEAR(studies::worst_force_error(hertz(3, 1.02), hertz(60, 1.0), 1e-3, 3e-3), 0.02, 1e-9);
  EXPECT_NEAR(studies::worst_force_error(hertz(60, 1.02), hertz(60, 1.0), 1e-3, 3e-3), 0.02, 1e-9);
}

TEST(ForceError, UnknownBeyondThePress) {
  EXPECT_TRUE(std::isnan(studies::worst_force_error(line(1.0), line(1.0), 1e-3, 4e-3)));
}

TEST(Pace, APressRecordsWhatEachPeriodTook) {
  lattice::PressSetup setup;
  setup.lattice.model = lattice::ModelKind::hookean;
  setup.lattice.spacing = setup.geometry.tip_radius / 4.0;
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing, 0.0);
  setup.protocol.depth = 2e-4;
  setup.protocol.samples = {2e-4};
  const lattice::PressOutcome outcome = lattice::run_press(setup);
  ASSERT_EQ(outcome.elapsed.size(), outcome.trace.size());
  for (std::size_t i = 1; i < outcome.elapsed.size(); ++i) {
    EXPECT_GE(outcome.elapsed[i].wall, outcome.elapsed[i - 1].wall);
    EXPECT_GE(outcome.elapsed[i].processor, outcome.elapsed[i - 1].processor);
  }
  EXPECT_GT(outcome.elapsed.back().processor, 0.0);
  EXPECT_LE(outcome.elapsed.back().wall, outcome.wall_time);
}
