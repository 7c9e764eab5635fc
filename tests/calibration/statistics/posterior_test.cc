/// A straight line with errors of every kind: what is told of them, and what it costs.
#include "calibration/statistics/posterior.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>

#include "calibration/statistics/curve_fit.h"

using namespace fingertip::calibration;
using Eigen::Index, Eigen::MatrixXd, Eigen::Vector2d, Eigen::VectorXd;

namespace {

constexpr int count = 40;
constexpr double slope = 3.0, noise = 0.02;

/// y = a x + z.
class Line final : public ForwardModel {
 public:
  CurveSlopes evaluate(const VectorXd& p) override {
    MatrixXd slopes(count, 2);
    slopes << VectorXd::LinSpaced(count, 0.05, 2.0), VectorXd::Ones(count);
    return {slopes * p, slopes};
  }
};

struct Drawn {
  PosteriorInput input;
  Line line;

  /// `zero` was not told, and is known to be about 0.01.
  Drawn(double zero, unsigned seed, std::optional<double> known_misfit = 0.01) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Curve curve;
    const VectorXd truth = line.evaluate(Vector2d(slope, zero)).value;
    for (int i = 0; i < count; ++i) {
      curve.x.push_back(i + 1.0);
      curve.y.push_back(truth(i) + noise * normal(random));
    }
    input.curves = {curve};
    input.models = {&line};
    input.options.free = {{.parameter = MaterialParameter::kappa, .start = 1.0, .scale = 1.0},
                          {.parameter = MaterialParameter::force_offset,
                           .prior = Prior{0.0, 0.01, true},
                           .scale = 1.0}};
    input.deviations = VectorXd::Ones(count);
    input.components = [known_misfit](const VectorXd&, const VectorXd& computed) {
      const MatrixXd smooth =
          computed.asDiagonal() * smooth_columns(VectorXd::LinSpaced(count, 0.0, 1.0), 0.5);
      return std::vector<ErrorComponent>{{smooth, *known_misfit}};
    };
  }
  Drawn(const Drawn&) = delete;

  Posterior posterior() {
    const CurveFit first = fit_curves(input.curves, input.models, input.options);
    Posterior found = posterior_fit(input, first);
    put_posterior(found.errors, found.options.free, found.fit);
    return found;
  }
};

TEST(Posterior, TellsTheNoise) {
  double sum = 0.0;
  for (unsigned seed = 1; seed <= 20; ++seed) sum += Drawn(0.0, seed).posterior().errors.noise / 20;
  EXPECT_NEAR(sum, noise, 0.1 * noise);
}

/// 50 times what is usual, as of a load cell that nobody has tared.
TEST(Posterior, APriorWithHeavyTailsGivesWay) {
  for (const double zero : {-0.5, 0.0, 0.5}) {
    const Posterior found = Drawn(zero, 7).posterior();
    EXPECT_NEAR(found.fit.estimates(1), zero, 3.0 * found.fit.standard_errors(1)) << zero;
    EXPECT_NEAR(found.fit.estimates(0), slope, 3.0 * found.fit.standard_errors(0)) << zero;
    EXPECT_LT(found.fit.standard_errors(1), 0.02);
  }
}

TEST(Posterior, IntervalsHoldTheTruthAsOftenAsTheySay) {
  int held = 0;
  constexpr int draws = 200;
  for (unsigned seed = 1; seed <= draws; ++seed) {
    std::mt19937 random(1000 + seed);
    const double zero = 0.01 * std::normal_distribution<double>()(random);
    const Posterior found = Drawn(zero, seed).posterior();
    held += found.fit.lower(0) <= slope && slope <= found.fit.upper(0) ? 1 : 0;
  }
  // There is no misfit, of which the interval keeps some: more often.
  EXPECT_GE(held, int(0.93 * draws));
}

/// A single value that is far off is named, and moves nothing.
TEST(Posterior, ASpikeCostsNothing) {
  Drawn clean(0.0, 3), spiked(0.0, 3);
  spiked.input.curves[0].y[17] += 30.0 * noise;
  const Posterior without = clean.posterior(), with = spiked.posterior();
  EXPECT_TRUE(without.odd.empty());
  ASSERT_EQ(with.odd.size(), 1u);
  EXPECT_EQ(with.odd[0], (OddValue{0, 17}));
  EXPECT_NEAR(with.fit.estimates(0), without.fit.estimates(0), without.fit.standard_errors(0));
  EXPECT_NEAR(with.fit.standard_errors(0), without.fit.standard_errors(0),
              0.1 * without.fit.standard_errors(0));
}

/// With hardly any misfit allowed it is generalised least squares.
TEST(Posterior, WithoutMisfitItIsLeastSquares) {
  Drawn drawn(0.0, 5, 1e-7);
  drawn.input.options.free[1].prior = Prior{0.0, 1e-9};
  const Posterior found = drawn.posterior();
  const VectorXd x = drawn.line.evaluate(Vector2d(1.0, 0.0)).value,
                 y = all_values(drawn.input.curves);
  EXPECT_NEAR(found.fit.estimates(0), x.dot(y) / x.squaredNorm(), 1e-5);
  const double deviation =
      std::sqrt((y - x * x.dot(y) / x.squaredNorm()).squaredNorm() / (count - 1));
  EXPECT_NEAR(found.fit.standard_errors(0), deviation / x.norm(), 0.05 * deviation / x.norm());
}

}  // namespace
