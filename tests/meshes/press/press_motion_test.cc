#include "meshes/press/press_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

using namespace fingertip::meshes;

namespace {

PressProtocol with_program(std::vector<PressStage> program) {
  PressProtocol protocol;
  protocol.program = std::move(program);
  protocol.speed = protocol.program.front().speed;
  protocol.depth =
      std::ranges::max_element(protocol.program, {}, &PressStage::indentation)->indentation;
  EXPECT_TRUE(protocol.violations(Geometry{}).empty());
  return protocol;
}

/// Down, a hold, up off the plane, down again by a way that is too short to reach the speed.
PressProtocol cycle() {
  return with_program({{3e-3, 0.01, 0.0},
                       {3e-3, 0.0, 0.4},
                       {-0.2e-3, 0.05, 0.0},
                       {-0.2e-3, 0.0, 0.1},
                       {0.1e-3, 0.02, 0.0},
                       {1.5e-3, 0.02, 0.0}});
}

TEST(PressMotion, StartsFromRestAndReachesItsSpeedBeforeThePlane) {
  for (const double speed : {0.001, 0.01, 0.2}) {
    const PressProtocol protocol{.speed = speed};
    const PressMotion motion(protocol);
    EXPECT_EQ(motion.at(0.0).speed, 0.0);
    EXPECT_EQ(motion.at(0.0).acceleration, 0.0);
    EXPECT_EQ(motion.at(-1.0).distance, 0.0);
    EXPECT_LE(motion.rise_time(), 0.03);
    EXPECT_LE(motion.at(motion.rise_time()).distance, 0.5 * protocol.clearance * (1.0 + 1e-12));
    EXPECT_NEAR(motion.indentation(motion.touch_time()), 0.0, 1e-15);
    EXPECT_EQ(motion.at(motion.rise_time()).speed, speed);
  }
}

TEST(PressMotion, WithoutAProgramItIsStillMovingAtItsDepthAndBeyond) {
  const PressProtocol protocol;
  const PressMotion motion(protocol);
  ASSERT_EQ(motion.stages().size(), 1u);
  EXPECT_FALSE(motion.stops());
  EXPECT_DOUBLE_EQ(motion.indentation(motion.duration()), protocol.depth);
  EXPECT_EQ(motion.at(motion.duration()).speed, protocol.speed);
  EXPECT_NEAR(motion.indentation(motion.duration() + 0.1), protocol.depth + 1e-3, 1e-15);
  EXPECT_NEAR(motion.time_at(4e-3), motion.duration() + 0.1, 1e-15);
  const std::vector<double> depths = default_samples(protocol.depth);
  ASSERT_EQ(motion.samples().size(), depths.size());
  for (std::size_t i = 0; i < depths.size(); ++i) {
    EXPECT_EQ(motion.samples()[i].indentation, depths[i]);
    EXPECT_NEAR(motion.indentation(motion.samples()[i].time), depths[i], 1e-15);
  }
}

TEST(PressMotion, SpeedAndAccelerationAreDerivativesOfTheDistance) {
  for (const PressMotion& motion : {PressMotion(PressProtocol{}), PressMotion(cycle())}) {
    const double h = 1e-6;
    for (double t = 0.001; t < motion.duration() + 0.05; t += 0.00037) {
      const SetPoint at = motion.at(t), later = motion.at(t + h), earlier = motion.at(t - h);
      EXPECT_NEAR(at.speed, (later.distance - earlier.distance) / (2 * h), 1e-7) << t;
      EXPECT_NEAR(at.acceleration, (later.speed - earlier.speed) / (2 * h), 2e-3) << t;
    }
  }
}

TEST(PressMotion, DistanceSpeedAndAccelerationAreContinuousWhereStagesMeet) {
  const PressMotion motion(cycle());
  for (const MotionStage& stage : motion.stages()) {
    for (const double time :
         {stage.begin, stage.begin + stage.rise, stage.end - stage.rise, stage.end}) {
      const double h = 1e-9;
      const SetPoint before = motion.at(time - h), after = motion.at(time + h);
      EXPECT_NEAR(before.distance, after.distance, 2e-10) << time;
      EXPECT_NEAR(before.speed, after.speed, 1e-7) << time;
      EXPECT_NEAR(before.acceleration, after.acceleration, 1e-4) << time;
    }
  }
}

TEST(PressMotion, EveryStageGoesFromRestToRestExactlyToItsEnd) {
  const PressProtocol protocol = cycle();
  const PressMotion motion(protocol);
  ASSERT_EQ(motion.stages().size(), protocol.program.size());
  double begin = 0.0, from = -protocol.clearance;
  for (std::size_t i = 0; i < protocol.program.size(); ++i) {
    const MotionStage& stage = motion.stages()[i];
    const PressStage& asked = protocol.program[i];
    EXPECT_EQ(stage.begin, begin);
    EXPECT_EQ(stage.from, from);
    EXPECT_EQ(stage.to, asked.indentation);
    EXPECT_EQ(motion.stage_at(stage.begin), i);
    EXPECT_LE(stage.rise, 0.03);
    const double way = std::abs(stage.to - from);
    const double lasts = stage.moves() ? way / asked.speed + stage.rise : asked.hold;
    EXPECT_NEAR(stage.end - stage.begin, lasts, 1e-15);
    EXPECT_EQ(motion.at(stage.end).distance, protocol.clearance + stage.to);
    EXPECT_EQ(motion.at(stage.end).speed, 0.0);
    EXPECT_EQ(motion.at(stage.end).acceleration, 0.0);
    begin = stage.end;
    from = stage.to;
  }
  EXPECT_EQ(motion.duration(), begin);
  EXPECT_TRUE(motion.stops());
  EXPECT_EQ(motion.at(motion.duration() + 1.0).distance, protocol.clearance + from);
}

TEST(PressMotion, TheSpeedIntegratesToTheWay) {
  const PressMotion motion(cycle());
  for (const MotionStage& stage : motion.stages()) {
    double way = 0.0;  // midpoints: second order, and the speed is smooth
    const int steps = 20000;
    const double h = (stage.end - stage.begin) / steps;
    for (int i = 0; i < steps; ++i) way += h * motion.at(stage.begin + (i + 0.5) * h).speed;
    EXPECT_NEAR(way, stage.to - stage.from, 1e-9);
  }
}

TEST(PressMotion, TheFirstLoadingIsThatOfTheUsualPressUntilItSlowsDown) {
  const PressMotion usual(PressProtocol{}), motion(cycle());
  const MotionStage& first = motion.stages().front();
  EXPECT_EQ(motion.touch_time(), usual.touch_time());
  for (double t = 0.0; t < first.end - first.rise; t += 0.0013)
    EXPECT_NEAR(motion.at(t).distance, usual.at(t).distance, 1e-18);
}

TEST(PressMotion, TimesOfIndentationsLeadBackToThem) {
  const PressMotion motion(cycle());
  for (std::size_t i = 0; i < motion.stages().size(); ++i) {
    const MotionStage& stage = motion.stages()[i];
    if (!stage.moves()) {
      EXPECT_EQ(motion.time_at(stage.to, i), stage.begin);
      continue;
    }
    double before = stage.begin;
    for (const double part : {0.0, 0.01, 0.3, 0.6, 0.99, 0.9999, 1.0}) {
      const double at = part == 1.0 ? stage.to : stage.from + part * (stage.to - stage.from);
      const double time = motion.time_at(at, i);
      EXPECT_GE(time, before);
      EXPECT_NEAR(motion.indentation(time), at, 1e-15) << "stage " << i;
      before = time;
    }
    EXPECT_THROW(motion.time_at(std::max(stage.from, stage.to) + 1e-6, i), std::out_of_range);
    EXPECT_THROW(motion.time_at(std::min(stage.from, stage.to) - 1e-6, i), std::out_of_range);
  }
}

TEST(PressMotion, SamplesGoOnInTimeAndEndEveryStage) {
  PressProtocol protocol = cycle();
  protocol.samples = {1e-3, 2e-3, 3e-3};
  const PressMotion motion(protocol);
  double before = 0.0;
  std::vector<std::vector<double>> depths(motion.stages().size());
  for (const MotionSample& sample : motion.samples()) {
    EXPECT_GT(sample.time, before);
    EXPECT_NEAR(motion.indentation(sample.time), sample.indentation, 1e-15);
    depths[sample.stage].push_back(sample.indentation);
    before = sample.time;
    if (sample.time == motion.stages()[sample.stage].end) {
      EXPECT_EQ(sample.indentation, motion.stages()[sample.stage].to);
    }
  }
  using Depths = std::vector<double>;
  EXPECT_EQ(depths[0], (Depths{1e-3, 2e-3, 3e-3}));
  EXPECT_EQ(depths[1], Depths(10, 3e-3));
  EXPECT_EQ(depths[2], (Depths{2e-3, 1e-3, -0.2e-3}));
  EXPECT_EQ(depths[4], Depths{0.1e-3});
  EXPECT_EQ(depths[5], (Depths{1e-3, 1.5e-3}));
  EXPECT_EQ(before, motion.duration());
}

}  // namespace
