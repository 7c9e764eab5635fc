/// 95 % intervals contain the truth in 95 % of experiments, of a model that costs nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/calibration/fit_fixtures.h"

using namespace fit_fixtures;

namespace {

/// y = sqrt(E G) x + G x².
FormulaModel cheap_press(const std::vector<double>& x) {
  return FormulaModel([x](const VectorXd& p) {
    CurveSlopes result{VectorXd(Index(x.size())), MatrixXd(Index(x.size()), 2)};
    for (Index i = 0; i < result.value.size(); ++i) {
      const double at = x[std::size_t(i)], root = std::sqrt(p(0) * p(1));
      result.value(i) = at * root + at * at * p(1);
      result.jacobian.row(i) << 0.5 * at * root / p(0), 0.5 * at * root / p(1) + at * at;
    }
    return result;
  });
}

}  // namespace

/// Of 1000 experiments 950 +- 7 (binomial); 3 standard deviations are allowed. Once with sigma
/// known and once with Student's t, at 4 degrees of freedom, where the normal quantile would give
/// 88 %.
TEST(Coverage, IntervalsHoldTheTruthAsOftenAsTheySay) {
  const std::vector<double> x = {0.2, 0.5, 0.9, 1.4, 2.0, 2.5};
  FormulaModel model = cheap_press(x);
  const Eigen::Vector2d truth(2.4, 1.0);
  const VectorXd exact = model.evaluate(truth).value;
  CurveFitOptions options;
  options.free = {{.parameter = youngs_modulus, .start = 2.2},
                  {.parameter = shear_modulus, .start = 1.1}};
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  for (const bool known : {true, false}) {
    int inside_e = 0, inside_g = 0;
    for (int experiment = 0; experiment < 1000; ++experiment) {
      Curve curve;
      curve.x = x;
      for (const double y : exact) {
        curve.y.push_back(y + 0.02 * normal(generator));
        if (known) curve.sigma.push_back(0.02);
      }
      const CurveFit fit = fit_curves({curve}, {&model}, options);
      inside_e += fit.lower(0) <= truth(0) && truth(0) <= fit.upper(0);
      inside_g += fit.lower(1) <= truth(1) && truth(1) <= fit.upper(1);
    }
    RecordProperty(known ? "known" : "unknown",
                   std::to_string(inside_e) + " " + std::to_string(inside_g));
    for (const int inside : {inside_e, inside_g}) {
      EXPECT_GE(inside, 930) << known;
      EXPECT_LE(inside, 970) << known;
    }
  }
}
