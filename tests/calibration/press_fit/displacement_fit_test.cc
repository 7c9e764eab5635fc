#include "calibration/press_fit/displacement_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/calibration/press_fit/displacement_draws.h"

using namespace displacement_draws;

namespace {

constexpr double truth = 0.45, noise = 1e-5;

std::vector<std::vector<Vector3>> fields_in(const std::vector<MeasuredDisplacements>& loads) {
  std::vector<std::vector<Vector3>> fields;
  for (const MeasuredDisplacements& load : loads) fields.push_back(load.displacement);
  return fields;
}

}  // namespace

/// Orthonormal fields keep the length of what they hold, and drop six numbers per load.
TEST(DisplacementMoments, KeepAFieldButForTheFramesMotion) {
  PressedDome dome;
  const auto still = dome.seen(truth, 0.0, 1);
  const DisplacementMoments moments(dome.places(), still, FrameMotion::fitted);
  EXPECT_LT((moments.of(dome.at(truth)) - moments.measured()).norm(),
            1e-9 * moments.measured().norm());
  EXPECT_LT((moments.of(fields_in(dome.seen(truth, 0.0, 2))) - moments.measured()).norm(),
            1e-9 * moments.measured().norm());
  const DisplacementMoments held(dome.places(), still, FrameMotion::held);
  for (std::size_t s = 0; s < 2; ++s)
    EXPECT_EQ(held.loads()[s].values, moments.loads()[s].values + 6);
}

/// Of noise alone values have its deviation, as far as they go.
TEST(DisplacementMoments, NoiseStaysWhatItIs) {
  PressedDome dome;
  const auto clean = dome.seen(truth, 0.0, 3), noisy = dome.seen(truth, noise, 3);
  const DisplacementMoments moments(dome.places(), clean, FrameMotion::fitted);
  double squares = 0.0;
  constexpr int draws = 20;
  for (unsigned seed = 0; seed < draws; ++seed)
    squares +=
        (moments.of(fields_in(dome.seen(truth, noise, seed))) - moments.measured()).squaredNorm() /
        double(moments.measured().size());
  EXPECT_NEAR(std::sqrt(squares / draws), noise, 0.05 * noise);
}

TEST(DisplacementMoments, RefuseFewPointsAndALine) {
  std::vector<Vector3> line;
  MeasuredDisplacements load{1e-3, {}};
  for (int i = 0; i < 12; ++i) {
    line.emplace_back(1e-3 * i, 0.0, 0.0);
    load.displacement.emplace_back(Vector3::Zero());
  }
  EXPECT_THROW(DisplacementMoments(line, {load}, FrameMotion::fitted), meshes::InvalidInput);
  for (int i = 0; i < 6; ++i) load.displacement[std::size_t(i)].setConstant(NAN);
  EXPECT_THROW(DisplacementMoments(line, {load}, FrameMotion::fitted), meshes::InvalidInput);
}

TEST(DisplacementFit, FindsTheRatioAndItsInterval) {
  PressedDome dome;
  const DisplacementFitFile fit = dome.fit(dome.seen(truth, noise, 7));
  EXPECT_LE(fit.lower, truth);
  EXPECT_GE(fit.upper, truth);
  EXPECT_LT(fit.upper - fit.lower, 0.1);
  EXPECT_NEAR(fit.noise, noise, 0.3 * noise);
  EXPECT_FALSE(fit.at_bound);
  EXPECT_TRUE(fit.failed.empty());
  // Where less is known the interval is wider: a factor of the fields, too.
  const DisplacementFitFile freed =
      dome.fit(dome.seen(truth, noise, 7), FrameMotion::fitted, {.compression = true});
  EXPECT_GT(freed.upper - freed.lower, fit.upper - fit.lower);
  for (const LoadEntry& load : freed.loads) {
    EXPECT_LE(load.stretch_lower, 1.0);
    EXPECT_GE(load.stretch_upper, 1.0);
  }
}

/// A frame that is held where it has moved spoils what is told, and the fit says so.
TEST(DisplacementFit, AFrameThatMovedMustNotBeHeld) {
  PressedDome dome;
  const DisplacementFitFile fit = dome.fit(dome.seen(truth, noise, 7), FrameMotion::held);
  EXPECT_FALSE(fit.failed.empty());
}

/// An incompressible rubber lies at the end of what is sought.
TEST(DisplacementFit, TellsWhereTheIntervalEndsAtItsBound) {
  PressedDome dome;
  const DisplacementFitFile fit = dome.fit(dome.seen(0.4995, 3e-5, 5));
  EXPECT_TRUE(fit.at_bound);
  EXPECT_GE(fit.upper, 0.495);
  EXPECT_LE(fit.lower, 0.4995);
}

TEST(DisplacementFit, IntervalsHoldTheTruth) {
  EXPECT_GE(inside(12, truth, noise), 10);
}
