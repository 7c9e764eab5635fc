// What the stages of a program came to, from the samples of a response.

#include "studies/presses/program_summary.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace fingertip;
using meshes::PressResponse;
using meshes::PressSample;

namespace {

PressSample sample(double indentation, double force, double stage = 1.0,
                   double time = meshes::unknown) {
  return {.indentation = indentation, .normal_force = force, .time = time, .stage = stage};
}

/// F = k d^1.5 to 2 mm, and back at `share` of it.
PressResponse loop(double share, int samples = 8) {
  const auto force = [](double d) { return 1e4 * std::pow(d, 1.5); };
  const double step = 2e-3 / samples;
  PressResponse response;
  for (int i = 1; i <= samples; ++i) response.append(sample(step * i, force(step * i)));
  for (int i = samples; i >= 0; --i)
    response.append(sample(step * i, share * force(step * i), i == samples ? 2.0 : 3.0));
  return response;
}

}  // namespace

TEST(WorkAlong, IsTheAreaOfTheLoop) {
  const double up = 1e4 * std::pow(2e-3, 2.5) / 2.5;
  // d^1.5 has no second derivative at first touch: the order is 2.5.
  for (const double share : {0.0, 0.6, 0.9}) {
    EXPECT_NEAR(studies::work_along(loop(share)), up * (1.0 - share), 1.5e-3 * up) << share;
    EXPECT_NEAR(studies::work_along(loop(share, 32)), up * (1.0 - share), 5e-5 * up) << share;
  }
  // What comes back as it went has no loop, however coarse the samples.
  EXPECT_NEAR(studies::work_along(loop(1.0)), 0.0, 1e-15);
}

TEST(WorkAlong, OfFewSamplesIsThatOfStraightLines) {
  EXPECT_DOUBLE_EQ(studies::work_along(PressResponse()), 0.0);
  EXPECT_DOUBLE_EQ(studies::work_along(PressResponse({sample(1e-3, 2.0)})), 1e-3);
  const PressResponse back({sample(1e-3, 2.0), sample(1e-3, 1.0, 2.0), sample(0.0, 0.0, 3.0)});
  EXPECT_DOUBLE_EQ(studies::work_along(back), 0.5e-3);
}

/// Loops along the plane and in twist, at one indentation.
TEST(WorkAlong, CountsWhatThePlaneDoesAlongItself) {
  const auto work = [](double PressSample::*way, double PressSample::*load, double end,
                       bool also_aside) {
    PressResponse response({sample(1e-3, 2.0)});
    for (const auto& [place, held] : {std::pair{0.0, 3.0}, {end, 3.0}, {end, -3.0}, {0.0, -3.0}}) {
      PressSample next = sample(1e-3, 2.0, 2.0);
      if (also_aside) next.lateral_displacement = 1e-4;
      next.*way = place;
      next.*load = held;
      response.append(next);
    }
    return studies::work_along(response);
  };
  EXPECT_NEAR(work(&PressSample::lateral_displacement, &PressSample::lateral_force_x, 1e-3, false),
              1e-3 + 6e-3, 1e-12);
  EXPECT_NEAR(work(&PressSample::twist, &PressSample::spin_torque, -0.1, false), 1e-3 - 0.6, 1e-12);
  EXPECT_TRUE(std::isnan(work(&PressSample::twist, &PressSample::spin_torque, 0.1, true)));
}

TEST(StageEntries, TellMotionsAlongThePlane) {
  meshes::PressProtocol protocol;
  using meshes::StageMove;
  protocol.program = {
      {1e-3, 0.01},
      {.indentation = 1e-3, .speed = 1e-3, .move = StageMove::lateral, .lateral = 2e-4},
      {.indentation = 1e-3, .speed = 0.1, .move = StageMove::twist, .lateral = 2e-4, .twist = 0.1}};
  protocol.depth = 1e-3;
  const auto entries = studies::stage_entries(
      protocol, PressResponse({sample(1e-3, 4.0), sample(1e-3, 3.0, 2.0), sample(1e-3, 2.0, 3.0)}));
  ASSERT_EQ(entries.size(), 3U);
  EXPECT_EQ(entries[0].kind, "move");
  EXPECT_EQ(entries[1].kind, "lateral");
  EXPECT_EQ(entries[1].lateral, 2e-4);
  EXPECT_EQ(entries[2].kind, "twist");
  EXPECT_EQ(entries[2].twist, 0.1);
  EXPECT_TRUE(std::isnan(entries[2].lateral));
  EXPECT_EQ(entries[2].begin_force, 3.0);
  EXPECT_EQ(entries[2].end_force, 2.0);
}

TEST(WorkAlong, TurnsAreFoundWithoutStages) {
  const PressResponse staged = loop(0.6);
  PressResponse plain;
  for (PressSample of : staged.samples()) {
    of.stage = meshes::unknown;
    plain.append(of);
  }
  EXPECT_DOUBLE_EQ(studies::work_along(plain), studies::work_along(staged));
}

TEST(StageEntries, OfAResponseInTimeTellRelaxation) {
  meshes::PressProtocol protocol;
  protocol.program = {{1e-3, 0.01}, {.indentation = 1e-3, .hold = 2.0}, {0.0, 0.01}};
  protocol.depth = 1e-3;
  protocol.speed = 0.01;
  const PressResponse response({sample(1e-3, 4.0, 1.0, 0.1), sample(1e-3, 3.5, 2.0, 1.0),
                                sample(1e-3, 3.0, 2.0, 2.1), sample(0.0, 0.0, 3.0, 2.2)});
  const auto entries = studies::stage_entries(protocol, response);
  ASSERT_EQ(entries.size(), 3U);
  EXPECT_DOUBLE_EQ(entries[0].begin, 0.0);
  EXPECT_DOUBLE_EQ(entries[1].begin, entries[0].end);
  EXPECT_NEAR(entries[1].end - entries[1].begin, 2.0, 1e-12);
  EXPECT_DOUBLE_EQ(entries[1].begin_force, 4.0);
  EXPECT_DOUBLE_EQ(entries[1].end_force, 3.0);
  EXPECT_DOUBLE_EQ(entries[1].relaxation, 0.25);
  EXPECT_DOUBLE_EQ(entries[2].end_force, 0.0);
}

TEST(StageEntries, WithoutTimeAHoldChangesNothing) {
  meshes::PressProtocol protocol;
  protocol.program = {{1e-3, 0.01}, {.indentation = 1e-3, .hold = 2.0}, {0.5e-3, 0.01}};
  const PressResponse response({sample(1e-3, 4.0), sample(0.5e-3, 1.0, 3.0)});
  const auto entries = studies::stage_entries(protocol, response);
  ASSERT_EQ(entries.size(), 3U);
  EXPECT_TRUE(std::isnan(entries[1].begin));
  EXPECT_TRUE(std::isnan(entries[1].relaxation));
  EXPECT_DOUBLE_EQ(entries[1].end_force, 4.0);
  EXPECT_DOUBLE_EQ(entries[2].end_force, 1.0);
  // A stage that was not reached.
  const auto broken = studies::stage_entries(protocol, PressResponse({sample(1e-3, 4.0)}));
  EXPECT_TRUE(std::isnan(broken[2].end_force));
}
