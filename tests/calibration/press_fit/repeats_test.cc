/// Scatter between repeats: what is told of it, and whether intervals that contain it are honest.
#include "calibration/press_fit/repeats.h"
#include "calibration/statistics/curve_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace fingertip::calibration;
using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr double modulus_value = 2e5;

/// Hertz: F = E 0.16 m² (delta/m)^1.5.
class HertzPress final : public ForwardModel {
 public:
  explicit HertzPress(std::vector<double> depths) : depths_(std::move(depths)) {}
  CurveSlopes evaluate(const VectorXd& parameters) override {
    CurveSlopes result{VectorXd(Index(depths_.size())), {}};
    for (std::size_t i = 0; i < depths_.size(); ++i)
      result.value(Index(i)) = parameters(0) * 0.16 * std::pow(depths_[i], 1.5);
    result.jacobian = result.value / parameters(0);
    return result;
  }

 private:
  std::vector<double> depths_;
};

struct Scatter {
  double between = 0.0, noise = 0.0;  ///< over the force; over the largest force
  bool with_sigma = true;
};

struct Experiment {
  std::vector<Curve> curves;
  std::vector<double> factors;
};

Experiment repeated(const Scatter& scatter, std::size_t count, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Experiment experiment;
  const double largest = modulus_value * 0.16 * std::pow(3e-3, 1.5);
  for (std::size_t k = 0; k < count; ++k) {
    experiment.factors.push_back(1.0 + scatter.between * normal(random));
    Curve curve;
    curve.course.noise = scatter.noise * largest;
    for (int i = 1; i <= 30; ++i) {
      const double x = 1e-4 * i;
      curve.x.push_back(x);
      curve.y.push_back(experiment.factors.back() * modulus_value * 0.16 * std::pow(x, 1.5) +
                        scatter.noise * largest * normal(random));
      if (scatter.with_sigma) curve.sigma.push_back(scatter.noise * largest);
    }
    experiment.curves.push_back(std::move(curve));
  }
  return experiment;
}

struct Answer {
  CurveFit alone;  ///< without the scatter
  Repeats repeats;
};

Answer answer(const Experiment& experiment) {
  std::vector<HertzPress> presses(experiment.curves.size(), HertzPress(experiment.curves[0].x));
  std::vector<ForwardModel*> models;
  std::vector<std::size_t> group;
  std::vector<VectorXd> zero;
  for (std::size_t i = 0; i < presses.size(); ++i) {
    models.push_back(&presses[i]);
    group.push_back(i);
    zero.push_back(VectorXd::Zero(30));
  }
  CurveFitOptions options;
  options.free = {{.parameter = MaterialParameter::modulus, .start = 1e5}};
  options.relative_singular_value = 0.0;
  Answer result;
  result.alone = fit_curves(experiment.curves, models, options);
  result.repeats = repeats_of(group, experiment.curves, result.alone, {},
                              std::vector<FitQuantity>(group.size()), zero);
  return result;
}

}  // namespace

TEST(Repeats, FactorsAreThoseOfThePresses) {
  std::mt19937 random(1);
  const Experiment experiment = repeated({0.1, 1e-5}, 4, random);
  const Answer found = answer(experiment);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_NEAR(found.repeats.factors[k] * found.alone.estimates(0) / modulus_value,
                experiment.factors[k], 1e-4);
  // Without noise the deviation is that of the factors as they are.
  double mean = 0.0, squares = 0.0;
  for (const double factor : found.repeats.factors) mean += factor / 4.0;
  for (const double factor : found.repeats.factors) squares += std::pow(factor - mean, 2) / 3.0;
  EXPECT_NEAR(found.repeats.deviation, std::sqrt(squares), 1e-4);
  EXPECT_LT(found.repeats.probability, 1e-6);
  // At half the travel: mean and deviation of four numbers.
  ASSERT_EQ(found.repeats.travel.size(), 40U);
  EXPECT_NEAR(found.repeats.travel[19], 1.5e-3, 1e-15);
  EXPECT_NEAR(found.repeats.scatter[19] / found.repeats.mean[19], std::sqrt(squares) / mean, 1e-4);
}

/// The method of moments: the square of the deviation is right in the mean.
TEST(Repeats, DeviationIsRightInTheMean) {
  for (const bool with_sigma : {true, false}) {
    std::mt19937 random(2);
    constexpr int seeds = 200;
    double squares = 0.0;
    int sure = 0;
    for (int seed = 0; seed < seeds; ++seed) {
      const Repeats found = answer(repeated({0.05, 0.02, with_sigma}, 6, random)).repeats;
      squares += std::pow(found.deviation / 0.05, 2) / seeds;
      sure += found.probability < 0.01 ? 1 : 0;
    }
    // The square has a deviation of sqrt(2/5) in one experiment, 0.045 in the mean of 200.
    EXPECT_NEAR(squares, 1.0, 0.16) << with_sigma;
    EXPECT_GT(sure, seeds / 2);
  }
}

TEST(Repeats, ThatDoNotScatterAreNotAccused) {
  std::mt19937 random(3);
  constexpr int seeds = 200;
  int below = 0;
  for (int seed = 0; seed < seeds; ++seed)
    below += answer(repeated({0.0, 0.02}, 5, random)).repeats.probability < 0.1 ? 1 : 0;
  // Binomial: 20 +- 4.2.
  EXPECT_NEAR(below, 20, 13);
}
