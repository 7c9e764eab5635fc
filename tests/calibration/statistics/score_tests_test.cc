/// What a fit has missed and what would narrow it, against refits and against solved normal
/// equations.
#include "calibration/statistics/score_tests.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "calibration/statistics/curve_fit.h"
#include "meshes/base/errors.h"

using namespace fingertip;
using namespace fingertip::calibration;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using enum MaterialParameter;

namespace {

/// y = M p.
class Linear final : public ForwardModel {
 public:
  explicit Linear(MatrixXd matrix) : matrix_(std::move(matrix)) {}
  CurveSlopes evaluate(const VectorXd& parameters) override {
    return {matrix_ * parameters, matrix_};
  }

 private:
  MatrixXd matrix_;
};

constexpr int count = 30;

/// Columns 1, x, x², sin 9x.
MatrixXd columns() {
  MatrixXd result(count, 4);
  for (int i = 0; i < count; ++i) {
    const double x = (i + 1.0) / count;
    result.row(i) << 1.0, x, x * x, std::sin(9.0 * x);
  }
  return result;
}

Curve curve_of(const VectorXd& y, bool sigma) {
  Curve curve;
  for (int i = 0; i < count; ++i) curve.x.push_back((i + 1.0) / count);
  curve.y.assign(y.begin(), y.end());
  if (sigma) curve.sigma.assign(count, 0.01);
  return curve;
}

VectorXd noisy(const VectorXd& p) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.01);
  VectorXd y = columns() * p;
  for (double& value : y) value += noise(random);
  return y;
}

/// The first two columns are fitted; kappa is no modulus, so that any sign is fine.
CurveFitOptions options(int parameters) {
  CurveFitOptions result;
  const MaterialParameter free[] = {kappa, lambda, touch_offset, force_offset};
  for (int i = 0; i < parameters; ++i)
    result.free.push_back({.parameter = free[i], .start = 0.5, .scale = 1.0});
  result.tolerance = 1e-9;
  return result;
}

CurveFit fit_of(const Curve& curve, int parameters, const std::vector<int>& places) {
  MatrixXd own(count, parameters);
  for (int i = 0; i < parameters; ++i) own.col(i) = columns().col(places[std::size_t(i)]);
  Linear model(own);
  return fit_curves({curve}, {&model}, options(parameters));
}

std::vector<OmittedEffect> both() {
  return {{"square", "", "", "1", columns().col(2)}, {"wave", "", "", "1", columns().col(3)}};
}

TEST(Suspects, TellWhatARefitWithTheirNumberFreeFinds) {
  const Curve curve = curve_of(noisy(Eigen::Vector4d(1.0, 2.0, 0.3, 0.02)), true);
  const CurveFit without = fit_of(curve, 2, {0, 1});
  const auto found = score_tests(without, options(2), both());
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].name, "square");
  for (const ScoreTest& each : found) {
    const CurveFit freed = fit_of(curve, 3, {0, 1, each.name == "square" ? 2 : 3});
    EXPECT_NEAR(each.decrease, *without.chi_square - *freed.chi_square, 1e-6 * each.decrease);
    EXPECT_NEAR(each.amount, freed.estimates(2), 1e-7);
  }
  EXPECT_LT(found[0].probability, 1e-6);
}

/// A number that is held at its bound: the fit to data without so much of the change.
TEST(Suspects, StayWithinTheirBounds) {
  Curve curve = curve_of(noisy(Eigen::Vector4d(1.0, 2.0, 0.3, 0.0)), true);
  const CurveFit without = fit_of(curve, 2, {0, 1});
  OmittedEffect square = both()[0];
  ASSERT_EQ(square.name, "square");
  square.least = 0.0;
  square.most = 0.1;
  const auto found = score_tests(without, options(2), {square});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].amount, 0.1);
  for (std::size_t i = 0; i < curve.y.size(); ++i) curve.y[i] -= 0.1 * square.change(Index(i));
  const CurveFit less = fit_of(curve, 2, {0, 1});
  EXPECT_NEAR(found[0].decrease, *without.chi_square - *less.chi_square,
              1e-6 * *without.chi_square);
  square.change = -square.change;
  const auto none = score_tests(without, options(2), {square});
  EXPECT_EQ(none[0].amount, 0.0);
  EXPECT_EQ(none[0].decrease, 0.0);
  EXPECT_EQ(none[0].probability, 1.0);
}

TEST(Suspects, WithoutSigmaAreJudgedByTheResidualVariance) {
  const Curve curve = curve_of(noisy(Eigen::Vector4d(1.0, 2.0, 0.3, 0.02)), false);
  const auto found = score_tests(fit_of(curve, 2, {0, 1}), options(2), both());
  const CurveFit without = fit_of(curve, 2, {0, 1}), freed = fit_of(curve, 3, {0, 1, 2});
  const double squares = without.residuals[0].squaredNorm(),
               left = freed.residuals[0].squaredNorm();
  const double variance = squares / without.degrees_of_freedom;
  EXPECT_EQ(found[0].name, "square");
  EXPECT_NEAR(found[0].decrease, (squares - left) / variance, 1e-6 * found[0].decrease);
  EXPECT_LT(found[0].probability, 1e-6);
}

TEST(Suspects, AccuseNobodyOfNoise) {
  const Curve curve = curve_of(noisy(Eigen::Vector4d(1.0, 2.0, 0.0, 0.0)), true);
  for (const ScoreTest& each : score_tests(fit_of(curve, 2, {0, 1}), options(2), both()))
    EXPECT_GT(each.probability, 0.01) << each.name;
}

TEST(Suspects, WhatTheParametersImitateIsLeftOut) {
  const Curve curve = curve_of(noisy(Eigen::Vector4d(1.0, 2.0, 0.3, 0.0)), true);
  const VectorXd sum = 3.0 * columns().col(0) - columns().col(1);
  EXPECT_TRUE(
      score_tests(fit_of(curve, 2, {0, 1}), options(2), {{"sum", "", "", "1", sum}}).empty());
  EXPECT_THROW(score_tests(fit_of(curve, 2, {0, 1}), options(2),
                           {{"short", "", "", "1", VectorXd::Ones(3)}}),
               meshes::InvalidInput);
}

/// Against the inverse of all normal equations, those of the further rows' own parameter included.
TEST(Narrowing, IsThatOfAllNormalEquationsTogether) {
  const MatrixXd first = 100.0 * columns().leftCols(2), further = 50.0 * columns().middleCols(1, 2);
  const VectorXd own = columns().col(3);
  MatrixXd normal = MatrixXd::Zero(3, 3);
  normal.topLeftCorner(2, 2) = first.transpose() * first + further.transpose() * further;
  normal.topRightCorner(2, 1) = further.transpose() * own;
  normal.bottomLeftCorner(1, 2) = own.transpose() * further;
  normal(2, 2) = own.squaredNorm();
  const VectorXd after = MatrixXd(normal.inverse()).diagonal().head(2).cwiseSqrt();
  const MatrixXd before = (first.transpose() * first).inverse();
  const VectorXd found = narrowing(before, further, own);
  for (Index i = 0; i < 2; ++i)
    EXPECT_NEAR(found(i), after(i) / std::sqrt(before(i, i)), 1e-9 * found(i));
  EXPECT_NEAR(narrowing(before, MatrixXd::Zero(4, 2), MatrixXd(4, 0))(0), 1.0, 1e-12);
}

}  // namespace

namespace {

/// Of a branch of weight 1 whose force without fading is `force`(s): rectangles of a thousandth.
template <typename Force>
double remembered(const Force& force, double time, double constant) {
  constexpr int steps = 100000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double s = time * i / steps, next = time * (i + 1) / steps;
    sum += std::exp((0.5 * (s + next) - time) / constant) * (force(next) - force(s));
  }
  return sum;
}

struct Ramp {
  std::vector<double> times;
  VectorXd forces;
};

template <typename Force>
Ramp ramp_of(const Force& force, int values) {
  Ramp ramp{{}, VectorXd(values)};
  for (int i = 0; i < values; ++i) {
    ramp.times.push_back(2.0 * i / (values - 1));
    ramp.forces(i) = force(ramp.times.back());
  }
  return ramp;
}

}  // namespace

/// ∫ exp(-(t-s)/c) a ds = a c (1 - exp(-t/c)), at times that are no even steps either.
TEST(Fading, OfASteadyForceIsTheClosedForm) {
  const std::vector<double> times = {0.0, 0.1, 0.5, 0.6, 2.0};
  const VectorXd forces = 3.0 * VectorXd::Map(times.data(), Index(times.size()));
  for (const double constant : {0.05, 0.7, 40.0}) {
    const VectorXd change = relaxation_change(forces, times, constant);
    for (std::size_t i = 0; i < times.size(); ++i)
      EXPECT_NEAR(change(Index(i)),
                  3.0 * constant * -std::expm1(-times[i] / constant) - 3.0 * times[i], 1e-13);
  }
  EXPECT_THROW(relaxation_change(forces, {0.0, 1.0}, 1.0), meshes::InvalidInput);
}

/// What is applied at once fades alone.
TEST(Fading, OfAStepIsExponential) {
  const VectorXd change = relaxation_change(VectorXd::Constant(3, 5.0), {1.0, 2.0, 4.0}, 1.5);
  EXPECT_DOUBLE_EQ(change(0), 0.0);
  EXPECT_NEAR(change(1), 5.0 * std::expm1(-1.0 / 1.5), 1e-14);
  EXPECT_NEAR(change(2), 5.0 * std::expm1(-3.0 / 1.5), 1e-14);
}

TEST(Fading, OfACurvedForceConvergesWithItsValues) {
  const auto force = [](double t) { return std::pow(t, 1.5); };
  const double truth = remembered(force, 2.0, 0.8) - force(2.0);
  double error[2] = {};
  for (int k = 0; k < 2; ++k) {
    const Ramp ramp = ramp_of(force, 20 << (2 * k));
    error[k] =
        std::abs(relaxation_change(ramp.forces, ramp.times, 0.8)(ramp.forces.size() - 1) - truth);
  }
  EXPECT_LT(error[1], 1e-4 * std::abs(truth));
  EXPECT_GT(error[0] / error[1], 8.0) << "second order would be 16";
}

/// A loop and a hold that are integrated here lead back to the weight that made them.
TEST(Fading, TellsTheWeightOfALoopAndOfAHold) {
  constexpr double weight = 0.15, constant = 0.8, turn = 2.0;
  const auto force = [](double t) {
    const double depth = t <= turn ? t : 2.0 * turn - t;
    return std::pow(std::max(0.0, depth), 1.5);
  };
  const auto told = [&](double t) {
    return (1.0 - weight) * force(t) + weight * remembered(force, t, constant);
  };
  const Ramp ramp = ramp_of(force, 201);
  double up = 0.0, down = 0.0;
  constexpr int steps = 200;
  for (int i = 0; i < steps; ++i) {
    const double t = turn * (i + 0.5) / steps;
    up += told(t) / steps;
    down += told(2.0 * turn - t) / steps;
  }
  LoadingHistory loop;
  loop.loop = (up - down) / up;
  EXPECT_GT(loop.loop, 0.05);
  EXPECT_NEAR(fading_of(loop, ramp.forces, ramp.times, ramp.times, constant), weight, 2e-3);
  LoadingHistory hold;
  hold.hold_time = 1.0;
  const double alive = remembered(force, turn, constant);
  hold.relaxation = weight * alive * -std::expm1(-hold.hold_time / constant) / told(turn);
  EXPECT_NEAR(fading_of(hold, ramp.forces, ramp.times, ramp.times, constant), weight, 2e-3);
  EXPECT_EQ(fading_of({}, ramp.forces, ramp.times, ramp.times, constant), 0.0);
}
