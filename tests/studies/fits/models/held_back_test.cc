/// What a fit foretells of a press that it has not seen, its interval, holds 95 % of such presses.
#include "studies/fits/models/held_back.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <random>

#include "calibration/press_fit/rig_model.h"
#include "calibration/statistics/curve_fit.h"
#include "studies/fits/models/fit_input.h"
#include "studies/fits/models/fit_repeats.h"
#include "studies/fits/models/fit_rig.h"
#include "studies/fits/models/travel.h"

using namespace fingertip;
using namespace fingertip::studies;
using calibration::PredictedEntry;
using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr double truth = 2e5, reach = 3e-3;

/// Hertz: F = E size delta^1.5, of another ball another size [m^0.5].
class Ball final : public calibration::ForwardModel {
 public:
  Ball(double size, std::vector<double> depths) : size_(size), depths_(std::move(depths)) {}
  calibration::CurveSlopes evaluate(const VectorXd& parameters) override {
    VectorXd force(Index(depths_.size()));
    for (Index i = 0; i < force.size(); ++i)
      force(i) = parameters(0) * size_ * std::pow(depths_[std::size_t(i)], 1.5);
    return {force, force / parameters(0)};
  }

 private:
  double size_;
  std::vector<double> depths_;
};

constexpr double small_ball = 0.16, large_ball = 0.3;

/// Presses are drawn: touch, noise of 1 % of the small ball's largest force, and what their model
/// misses, by so much over the depth.
struct Drawn {
  double missed = 0.0, factor = 1.0;  ///< of the second press
  std::mt19937 random;

  calibration::Curve press(double size, double own_factor) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> touches(0.1e-3, 0.6e-3);
    const double touch = touches(random), largest = truth * small_ball * std::pow(reach, 1.5),
                 tilt = missed * normal(random), bend = missed * normal(random);
    calibration::Curve curve;
    curve.is_travel = true;
    for (int i = 0; i <= 40; ++i) {
      curve.x.push_back((reach + 0.6e-3) * i / 40);
      const double depth = std::max(0.0, curve.x.back() - touch), u = depth / reach;
      const double off = own_factor * (1.0 + tilt * (u - 0.5) + bend * std::cos(3.0 * u));
      curve.y.push_back(off * truth * size * std::pow(depth, 1.5) +
                        0.01 * largest * normal(random));
    }
    return curve;
  }
};

CalibrationSettings machine() {
  CalibrationSettings settings;
  settings.rig.compliance = settings.rig.force_offset = settings.rig.drift = {.given = true};
  return settings;
}

/// The first curves fitted as calibrate does it, the last one foretold; `sizes` of their balls.
PredictedEntry foretold(std::vector<FitCurve> curves, const std::vector<double>& sizes) {
  FitInput all;
  all.problem = CalibrationProblem::experiment;
  all.curves = std::move(curves);
  all.options.tolerance = 1e-2;
  all.options.free = {
      {.parameter = calibration::MaterialParameter::modulus, .start = 0.75 * truth}};
  for (std::size_t i = 0; i < all.curves.size(); ++i) {
    FitCurve& curve = all.curves[i];
    curve.name = std::to_string(i), curve.condition = std::to_string(sizes[i]);
    if (curve.is_travel) curve.travel = travel_of(curve, machine());
  }
  const bool travels = all.curves.front().is_travel;
  if (travels) share_depths(all), free_rigs(all);
  FitInput fitted = all;
  fitted.curves.pop_back();
  const FitCurve& last = all.curves.back();
  if (travels && !last.continues) fitted.options.free.pop_back();  // its touch
  fitted.with_held_back = std::make_shared<const FitInput>(all);
  std::deque<Ball> balls;
  std::deque<calibration::RigModel> rigs;
  const auto models_for = [&](const FitInput& input) {
    std::vector<calibration::ForwardModel*> list;
    for (std::size_t i = 0; i < input.curves.size(); ++i) {
      const FitCurve& curve = input.curves[i];
      if (!travels) {
        list.push_back(&balls.emplace_back(sizes[i], curve.x));
        continue;
      }
      Ball& ball = balls.emplace_back(sizes[i], curve.travel->depths);
      list.push_back(&rigs.emplace_back(ball, curve.travel->depths, 1, curve.travel->rig, curve.x,
                                        curve.time, Index(input.options.free.size())));
    }
    return list;
  };
  const auto models = models_for(fitted);
  calibration::FitRecord record;
  record.curves = curves_of(fitted);
  record.fit = calibration::fit_curves(record.curves, models, fitted.options);
  add_errors_and_intervals(fitted, models, record);
  return predicted_press(fitted, fitted.curves.size(), models_for(all), record);
}

/// Of so many drawn pairs the share that is inside.
double inside(int seeds, Drawn drawn) {
  int held = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    drawn.random.seed(unsigned(seed));
    const auto fitted = drawn.press(small_ball, 1.0), other = drawn.press(large_ball, drawn.factor);
    held += foretold({fitted, other}, {small_ball, large_ball}).is_within() ? 1 : 0;
  }
  return double(held) / seeds;
}

}  // namespace

/// Of 60 at 95 % 3 are outside, more than 8 once in 200 times; what a model may miss unseen makes
/// the intervals wider than noise alone would.
TEST(HeldBack, PressesOfAnotherBallAreForetold) {
  for (const double missed : {0.0, 0.03}) EXPECT_GE(inside(60, {missed, 1.0, {}}), 0.86) << missed;
}

TEST(HeldBack, AnotherRubberIsOutside) {
  EXPECT_LE(inside(20, {0.0, 1.2, {}}), 0.1);
  EXPECT_LE(inside(20, {0.0, 0.8, {}}), 0.1);
}

/// Further rows of a press have its touch, so that nothing is estimated from them.
TEST(HeldBack, FurtherRowsOfAPressHaveItsTouch) {
  int held = 0;
  constexpr int seeds = 40;
  for (int seed = 1; seed <= seeds; ++seed) {
    Drawn drawn;
    drawn.random.seed(unsigned(seed));
    const calibration::Curve whole = drawn.press(small_ball, 1.0);
    FitCurve first(whole), further(whole);
    first.x.resize(24), first.y.resize(24);
    further.x.erase(further.x.begin(), further.x.begin() + 24);
    further.y.erase(further.y.begin(), further.y.begin() + 24);
    further.continues = 0;
    const PredictedEntry entry = foretold({first, further}, {small_ball, small_ball});
    EXPECT_TRUE(entry.own.empty());
    held += entry.is_within() ? 1 : 0;
  }
  EXPECT_GE(held, 34);
}

/// A few values without noise: one force tells the modulus, and what the model may miss decides.
TEST(HeldBack, FewValuesHaveWideIntervals) {
  FitCurve first, deeper;
  for (const double depth : {1e-3, 2e-3}) {
    first.x.push_back(0.5 * depth), deeper.x.push_back(2.0 * depth);
    first.y.push_back(truth * small_ball * std::pow(0.5 * depth, 1.5));
    deeper.y.push_back(truth * small_ball * std::pow(2.0 * depth, 1.5));
  }
  const PredictedEntry entry = foretold({first, deeper}, {small_ball, small_ball});
  EXPECT_TRUE(entry.is_within());
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(entry.foretold[i], deeper.y[i], 0.02 * deeper.y[i]);
    EXPECT_GT(entry.upper[i] - entry.lower[i], 0.01 * deeper.y[i]);
    EXPECT_LT(entry.upper[i] - entry.lower[i], 0.5 * deeper.y[i]);
  }
}
