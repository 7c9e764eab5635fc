#include "calibration/statistics/value_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "calibration/statistics/fit_statistics.h"
#include "meshes/base/errors.h"

using namespace fingertip;
using namespace fingertip::calibration;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Forces of Hertz, F = E u^1.5, one modulus, at so many depths up to 1.
struct Hertz {
  explicit Hertz(Index values)
      : u(VectorXd::LinSpaced(values, 1.0 / double(values), 1.0)), force(u.array().pow(1.5)) {}

  LinearisedFit fit(const VectorXd& errors, double deviation, bool told) const {
    LinearisedFit at;
    at.residuals = errors;
    at.jacobian = force;
    at.estimates = VectorXd::Ones(1);
    at.free = {{.parameter = MaterialParameter::modulus, .start = 1.0}};
    at.deviations = VectorXd::Constant(force.size(), deviation);
    at.noise_told = told;
    return at;
  }
  ErrorComponent missed() const { return {force.asDiagonal() * smooth_columns(u, 0.25), 0.01}; }
  VectorXd u, force;
};

VectorXd drawn(Index count, std::mt19937& random) {
  std::normal_distribution<double> normal;
  return VectorXd::NullaryExpr(count, [&] { return normal(random); });
}

}  // namespace

TEST(ValueErrors, SmoothColumnsHaveTheKernelAsTheirCovariance) {
  const VectorXd u = VectorXd::LinSpaced(37, 0.0, 1.0);
  for (const double length : {0.1, 0.25, 1.0}) {
    const MatrixXd columns = smooth_columns(u, length), own = columns * columns.transpose();
    for (Index i = 0; i < u.size(); ++i)
      for (Index j = 0; j < u.size(); ++j)
        EXPECT_NEAR(own(i, j), std::exp(-0.5 * std::pow((u(i) - u(j)) / length, 2)), 2e-5);
    EXPECT_LT(columns.cols(), 30);
  }
}

/// Without a component, and with much to tell the noise, it is the ordinary fit.
TEST(ValueErrors, IsLeastSquaresWhereNoiseIsAllThereIs) {
  std::mt19937 random(3);
  const Hertz hertz(400);
  const VectorXd noise = 0.02 * drawn(400, random);
  const ValueErrors found = value_errors(hertz.fit(noise, 1.0, false), {});
  const double square = hertz.force.squaredNorm(), shift = hertz.force.dot(noise) / square,
               deviation = (noise - shift * hertz.force).norm() / std::sqrt(399.0);
  EXPECT_NEAR(found.mean(0), 1.0 + shift, 1e-9);
  EXPECT_NEAR(found.noise, deviation, 0.03 * deviation);
  EXPECT_NEAR(found.upper(0) - found.lower(0),
              2.0 * student_95(399.0) * deviation / std::sqrt(square),
              0.1 * 4e-2 / std::sqrt(square));
}

/// Of four values Student's t of three degrees of freedom.
TEST(ValueErrors, FewValuesWidenAsStudentsT) {
  const Hertz hertz(4);
  VectorXd errors(4);
  errors << 0.03, -0.05, 0.01, 0.02;
  const ValueErrors found = value_errors(hertz.fit(errors, 1.0, false), {});
  const double square = hertz.force.squaredNorm(), shift = hertz.force.dot(errors) / square,
               half = student_95(3.0) * (errors - shift * hertz.force).norm() /
                      std::sqrt(3.0 * square);
  EXPECT_NEAR(0.5 * (found.upper(0) - found.lower(0)), half, 0.15 * half);
}

/// Data drawn from the model itself, sizes too: intervals hold the truth in 95 % of them.
TEST(ValueErrors, IntervalsCoverWhatIsDrawn) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform;
  constexpr int sets = 300;
  int covered = 0, noise_right = 0;
  for (int set = 0; set < sets; ++set) {
    const Hertz hertz(Index(10 + 60 * uniform(random)));
    const double noise = 0.002 * std::pow(20.0, uniform(random)),
                 size = 0.01 * std::tan(0.5 * std::numbers::pi * uniform(random));
    const ErrorComponent missed = hertz.missed();
    const VectorXd errors =
        noise * drawn(hertz.u.size(), random) +
        missed.columns * drawn(missed.columns.cols(), random) * std::min(size, 0.9);
    const bool told = set % 2 == 0;
    const ValueErrors found = value_errors(hertz.fit(errors, told ? noise : 1.0, told), {missed});
    covered += found.lower(0) <= 1.0 && 1.0 <= found.upper(0) ? 1 : 0;
    const double factor = found.noise / (told ? 1.0 : noise);
    noise_right += factor > 0.5 && factor < 2.0 ? 1 : 0;
  }
  EXPECT_GE(covered, 0.92 * sets);
  EXPECT_LE(covered, 0.985 * sets);
  EXPECT_GE(noise_right, 0.95 * sets);
}

/// A stiffening of the force by a tenth at its end is no noise; noise alone is no misfit.
TEST(ValueErrors, ToldFromNoiseIsWhatIsSmooth) {
  std::mt19937 random(5);
  const Hertz hertz(60);
  const VectorXd noise = 0.002 * drawn(60, random),
                 stiffer = 0.1 * hertz.force.cwiseProduct(VectorXd(hertz.u.array().pow(3)));
  const ValueErrors bent = value_errors(hertz.fit(noise + stiffer, 1.0, false), {hertz.missed()}),
                    plain = value_errors(hertz.fit(noise, 1.0, false), {hertz.missed()});
  EXPECT_GT(bent.seen[0], 50.0);
  EXPECT_LT(plain.seen[0], 6.0);
  EXPECT_NEAR(bent.noise, 0.002, 0.0006);
  EXPECT_NEAR(plain.noise, 0.002, 0.0006);
  EXPECT_GT(bent.upper(0) - bent.lower(0), 5.0 * (plain.upper(0) - plain.lower(0)));
  EXPECT_TRUE(bent.lower(0) < 1.0 && 1.0 < bent.upper(0));
  // With the misfit taken out the rest is noise.
  const VectorXd left = noise + stiffer - hertz.force * (bent.mean(0) - 1.0) - bent.parts[0];
  EXPECT_LT(left.norm() / std::sqrt(60.0), 0.003);
}

/// Factors of repeats: with three of them the interval is Student's t of two degrees of freedom.
TEST(ValueErrors, ThreeRepeatsAreThreeValues) {
  const Hertz hertz(20);
  const double factors[] = {0.9, 1.0, 1.13};
  VectorXd errors(60), force(60);
  MatrixXd columns = MatrixXd::Zero(60, 3);
  std::mt19937 random(2);
  for (int k = 0; k < 3; ++k) {
    errors.segment(20 * k, 20) = (factors[k] - 1.0) * hertz.force + 1e-4 * drawn(20, random);
    columns.col(k).segment(20 * k, 20) = force.segment(20 * k, 20) = hertz.force;
  }
  LinearisedFit at = hertz.fit(errors, 1.0, false);
  at.jacobian = force;
  at.deviations = VectorXd::Ones(60);
  const ValueErrors found = value_errors(at, {{columns, 0.05}});
  const double mean = 1.01, deviation = std::sqrt((0.0121 + 0.0001 + 0.0144) / 2.0);
  EXPECT_NEAR(found.mean(0), mean, 0.002);
  // Which knows that repeats seldom differ by more than a few per cent.
  const double half = student_95(2.0) * deviation / std::sqrt(3.0);
  EXPECT_GT(found.upper(0) - found.lower(0), 1.1 * half);
  EXPECT_LT(found.upper(0) - found.lower(0), 2.2 * half);
  EXPECT_GT(found.sizes[0], 0.05);
  EXPECT_GT(found.seen[0], 50.0);
}

/// Known errors of a model, common to all values, are in the interval whatever the values say.
TEST(ValueErrors, KnownErrorsOfTheModelStayInTheInterval) {
  std::mt19937 random(8);
  const Hertz hertz(200);
  LinearisedFit at = hertz.fit(1e-3 * drawn(200, random), 1e-3, true);
  at.model_covariance = 4e-4 * hertz.force * hertz.force.transpose();  // 2 %
  const ValueErrors found = value_errors(at, {});
  EXPECT_NEAR(found.upper(0) - found.lower(0), 2.0 * normal_95() * 0.02, 0.002);
}

/// In whatever unit the deviations are, and higher for the model that is right.
TEST(ValueErrors, EvidenceComparesModels) {
  std::mt19937 random(4);
  const Hertz hertz(40);
  const VectorXd noise = 0.01 * drawn(40, random),
                 bent = noise + 0.1 * hertz.force.cwiseProduct(hertz.u);
  const double right = value_errors(hertz.fit(noise, 1.0, false), {hertz.missed()}).log_evidence;
  EXPECT_NEAR(value_errors(hertz.fit(noise, 1e-3, false), {hertz.missed()}).log_evidence, right,
              0.2);
  EXPECT_GT(right, value_errors(hertz.fit(bent, 1.0, false), {hertz.missed()}).log_evidence + 2.0);
}

TEST(ValueErrors, RefusesSizesThatDoNotFit) {
  const Hertz hertz(5);
  LinearisedFit at = hertz.fit(VectorXd::Zero(4), 1.0, true);
  EXPECT_THROW(value_errors(at, {}), meshes::InvalidInput);
  at = hertz.fit(VectorXd::Zero(5), 0.0, true);
  EXPECT_THROW(value_errors(at, {}), meshes::InvalidInput);
  at = hertz.fit(VectorXd::Zero(5), 1.0, true);
  const ErrorComponent other{MatrixXd::Ones(4, 1), 0.01};
  EXPECT_THROW(value_errors(at, {other}), meshes::InvalidInput);
}

/// Of many values whose noise is all there is, and of one further: sigma² (1 + J*²/JᵀJ), the mean
/// where the values are.
TEST(FurtherValues, AreThoseOfALineThroughManyValues) {
  std::mt19937 random(5);
  const Hertz hertz(400);
  const LinearisedFit fit = hertz.fit(0.01 * drawn(400, random) + 0.002 * hertz.force, 0.01, true);
  const FurtherValues further{VectorXd::Constant(1, 20.0), {}, VectorXd::Constant(1, 0.01)};
  const MatrixXd draws = further_values(fit, {}, further, 20000);
  ASSERT_GT(draws.cols(), 19000);
  const double squares = hertz.force.squaredNorm(),
               mean = 20.0 * hertz.force.dot(fit.residuals) / squares,
               deviation = 0.01 * std::sqrt(1.0 + 400.0 / squares);
  EXPECT_NEAR(draws.mean(), mean, 0.03 * deviation);
  EXPECT_NEAR(std::sqrt((draws.array() - draws.mean()).square().mean()), deviation,
              0.04 * deviation);
}

/// What is known to be missed and shared goes along: values that err together by v err further by
/// as much as they were seen to, if noise is nothing.
TEST(FurtherValues, ShareWhatIsKnownToBeMissed) {
  const Hertz hertz(50);
  const VectorXd shape = VectorXd::LinSpaced(50, 0.0, 1.0);
  const LinearisedFit fit = hertz.fit(0.7 * shape, 1e-4, true);
  const ErrorComponent known{MatrixXd(shape), 1.0, true};
  const FurtherValues further{
      VectorXd::Zero(1), {MatrixXd::Constant(1, 1, 2.0)}, VectorXd::Constant(1, 1e-4)};
  EXPECT_NEAR(further_values(fit, {known}, further, 2000).mean(), 1.4, 0.01);
}
