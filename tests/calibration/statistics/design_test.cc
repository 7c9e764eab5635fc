/// What presses would tell before they are made: against Monte Carlo of real fits and closed forms.
#include "calibration/statistics/design.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "calibration/statistics/fit_options.h"
#include "calibration/statistics/score_tests.h"
#include "meshes/base/errors.h"

using namespace fingertip;
using namespace fingertip::calibration;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// y = p0 + p1 x at n places.
MatrixXd line(int n) {
  MatrixXd jacobian(n, 2);
  for (int i = 0; i < n; ++i) jacobian.row(i) << 1.0, double(i);
  return jacobian;
}

std::vector<FreeParameter> two_free() {
  return {{.parameter = MaterialParameter::k1}, {.parameter = MaterialParameter::touch_offset}};
}

}  // namespace

/// The textbook's straight line: var(slope) = s²/Sxx, var(intercept) = s² (1/n + x̄²/Sxx).
TEST(Design, AStraightLineHasItsTextbookErrors) {
  constexpr int n = 12;
  constexpr double s = 0.3;
  const MatrixXd covariance =
      predicted_covariance({line(n), VectorXd::Constant(n, s), {}}, two_free());
  const double mean = 0.5 * (n - 1), sxx = n * (n * n - 1.0) / 12.0;
  EXPECT_NEAR(covariance(1, 1), s * s / sxx, 1e-12);
  EXPECT_NEAR(covariance(0, 0), s * s * (1.0 / n + mean * mean / sxx), 1e-12);
  EXPECT_NEAR(covariance(0, 1), -s * s * mean / sxx, 1e-12);
}

/// A parameter that nothing but its prior tells keeps the prior; one that both tell adds weights.
TEST(Design, PriorsAddTheirWeight) {
  std::vector<FreeParameter> free = two_free();
  free[1].prior = Prior{5.0, 0.25};
  MatrixXd jacobian = MatrixXd::Zero(4, 2);
  jacobian.col(0).setOnes();
  free[0].prior = Prior{0.0, 1.0};
  const MatrixXd covariance =
      predicted_covariance({jacobian, VectorXd::Constant(4, 2.0), {}}, free);
  EXPECT_NEAR(covariance(1, 1), 0.0625, 1e-14);
  EXPECT_NEAR(covariance(0, 0), 1.0 / (4.0 / 4.0 + 1.0), 1e-14);
}

/// An error common to all values, v vᵀ, is one more parameter with a standard normal prior.
TEST(Design, ACommonErrorOfTheModelIsAParameterMore) {
  constexpr int n = 9;
  const MatrixXd jacobian = line(n);
  const VectorXd sigma = VectorXd::LinSpaced(n, 0.1, 0.5);
  VectorXd v(n);
  for (int i = 0; i < n; ++i) v(i) = 0.2 * std::sin(1.0 + i);
  const MatrixXd found = predicted_covariance({jacobian, sigma, v * v.transpose()}, two_free());
  MatrixXd wider(n, 3);
  wider << jacobian, v;
  std::vector<FreeParameter> free = two_free();
  free.push_back({.parameter = MaterialParameter::k3, .prior = Prior{0.0, 1.0}});
  const MatrixXd expected = predicted_covariance({wider, sigma, {}}, free);
  EXPECT_LT((found - expected.topLeftCorner(2, 2)).norm(), 1e-12 * found.norm());
}

/// The scatter of a thousand fits to noisy data is what was predicted, within the 7 % that a
/// thousand of them leave open (three standard errors of a deviation, 1/sqrt(2n) each).
TEST(Design, PredictsTheScatterOfFits) {
  constexpr int n = 10, fits = 1000;
  const MatrixXd jacobian = line(n);
  const VectorXd sigma = VectorXd::LinSpaced(n, 0.5, 2.0);
  const VectorXd weight = sigma.cwiseAbs2().cwiseInverse();
  std::mt19937 random(7);
  std::normal_distribution<double> deviate;
  MatrixXd scatter = MatrixXd::Zero(2, 2);
  for (int k = 0; k < fits; ++k) {
    VectorXd noise(n);
    for (int i = 0; i < n; ++i) noise(i) = sigma(i) * deviate(random);
    // The normal equations by Cramer's rule.
    const double a = weight.sum(), b = weight.dot(jacobian.col(1)),
                 c = weight.dot(jacobian.col(1).cwiseAbs2()), r0 = weight.dot(noise),
                 r1 = weight.cwiseProduct(jacobian.col(1)).dot(noise), det = a * c - b * b;
    const Eigen::Vector2d p((c * r0 - b * r1) / det, (a * r1 - b * r0) / det);
    scatter += p * p.transpose() / fits;
  }
  const MatrixXd told = predicted_covariance({jacobian, sigma, {}}, two_free());
  for (int i = 0; i < 2; ++i)
    EXPECT_NEAR(std::sqrt(scatter(i, i) / told(i, i)), 1.0, 3.0 / std::sqrt(2.0 * fits));
}

/// Rows added here, and rows added to what is known by Woodbury's identity.
TEST(Design, AgreesWithTheNarrowingOfAKnownCovariance) {
  const MatrixXd jacobian = line(5);
  const VectorXd sigma = VectorXd::Constant(5, 0.2);
  const MatrixXd before = predicted_covariance({jacobian, sigma, {}}, two_free());
  MatrixXd all = MatrixXd::Zero(9, 3);
  all.topLeftCorner(5, 2) = jacobian;
  for (int i = 0; i < 4; ++i) all.row(5 + i) << 0.0, std::sqrt(1.0 + i), 1.0;
  std::vector<FreeParameter> free = two_free();
  free.push_back({.parameter = MaterialParameter::force_offset});
  const MatrixXd after = predicted_covariance({all, VectorXd::Constant(9, 0.2), {}}, free);
  const VectorXd expected =
      narrowing(before, all.bottomLeftCorner(4, 2) / 0.2, all.bottomRightCorner(4, 1) / 0.2);
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(std::sqrt(after(i, i) / before(i, i)), expected(i), 1e-9);
}

TEST(Design, NamesThePairsThatAreNearlyCollinear) {
  MatrixXd covariance = MatrixXd::Identity(3, 3);
  covariance(0, 2) = covariance(2, 0) = -0.99;
  covariance(0, 1) = covariance(1, 0) = 0.9;
  const auto pairs = nearly_collinear(covariance);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].first, 0u);
  EXPECT_EQ(pairs[0].second, 2u);
  EXPECT_NEAR(pairs[0].times, 1.0 / std::sqrt(1.0 - 0.99 * 0.99), 1e-9);
}

TEST(Design, SortsByWhatTheRubberGains) {
  std::vector<MeasurementGain> gains(3);
  gains[0] = {"fails", "", {}, "no"};
  gains[1] = {"rig only", "", Eigen::Vector2d(1.1, 9.0), ""};
  gains[2] = {"rubber", "stick", Eigen::Vector2d(2.0, 1.0), ""};
  sort_by_gain(gains, 1);
  EXPECT_EQ(gains[0].name, "rubber");
  EXPECT_EQ(gains[2].name, "fails");
  const std::string said = gain_statement(gains, {"modulus", "compliance"}, 1);
  EXPECT_NE(said.find("rubber would tell most (stick)"), std::string::npos) << said;
  EXPECT_NE(said.find("modulus 2 times"), std::string::npos) << said;
  EXPECT_EQ(gain_statement({}, {}, 1), "");
  gains[0].times = Eigen::Vector2d(1.05, 9.0);  // what the rubber does not gain is not meant
  EXPECT_EQ(gain_statement(gains, {"modulus", "compliance"}, 1),
            "None of the further measurements tried would make the interval of modulus a tenth "
            "narrower.");
}

TEST(Design, RefusesWhatIsNoObservation) {
  EXPECT_THROW(predicted_covariance({line(3), VectorXd::Ones(2), {}}, two_free()),
               meshes::InvalidInput);
  EXPECT_THROW(predicted_covariance({line(3), VectorXd::Zero(3), {}}, two_free()),
               meshes::InvalidInput);
  EXPECT_THROW(predicted_covariance({line(3), VectorXd::Ones(3), {}}, {two_free()[0]}),
               meshes::InvalidInput);
  EXPECT_THROW(predicted_covariance({line(3), VectorXd::Ones(3), -10.0 * MatrixXd::Identity(3, 3)},
                                    two_free()),
               meshes::InvalidInput);
}
