/// Fits to curves: estimates and standard errors against certified values of a nonlinear regression
/// and textbook formulas, recovery of E and G, and what a single curve cannot say.
#include "calibration/statistics/curve_fit.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "calibration/press_fit/lattice_forward_model.h"
#include "calibration/press_fit/scaled_model.h"
#include "calibration/statistics/fit_statistics.h"
#include "tests/calibration/fit_fixtures.h"

using namespace fit_fixtures;

/// NIST StRD, nonlinear regression, Misra1a: y = b1 (1 - exp(-b2 x)), certified to 11 digits.
TEST(CurveFit, MeetsCertifiedEstimatesAndStandardErrors) {
  Curve data;
  data.x = {77.6,  114.9, 141.1, 190.8, 239.9, 289.0, 332.8,
            378.4, 434.8, 477.3, 536.8, 593.1, 689.1, 760.0};
  data.y = {10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02,
            44.82, 50.76, 55.05, 61.01, 66.40, 75.47, 81.78};
  FormulaModel model([&](const VectorXd& b) {
    CurveSlopes result{VectorXd(14), MatrixXd(14, 2)};
    for (Index i = 0; i < 14; ++i) {
      const double x = data.x[std::size_t(i)], decay = std::exp(-b(1) * x);
      result.value(i) = b(0) * (1.0 - decay);
      result.jacobian.row(i) << 1.0 - decay, b(0) * x * decay;
    }
    return result;
  });
  CurveFitOptions options;
  options.free = {{.parameter = kappa, .start = 500.0}, {.parameter = lambda, .start = 1e-4}};
  const CurveFit fit = fit_curves({data}, {&model}, options);
  EXPECT_NEAR(fit.estimates(0), 2.3894212918e2, 1e-6);
  EXPECT_NEAR(fit.estimates(1), 5.5015643181e-4, 1e-12);
  EXPECT_NEAR(fit.standard_errors(0), 2.7070075241, 1e-6);
  EXPECT_NEAR(fit.standard_errors(1), 7.2668688436e-6, 1e-12);
  EXPECT_EQ(fit.degrees_of_freedom, 12);
  EXPECT_NEAR(fit.residual_deviation, 1.0187876330e-1, 1e-9);
  EXPECT_NEAR(fit.residuals[0].squaredNorm(), 1.2455138894e-1, 1e-9);
  // Student's t at 0.975 and 12 degrees of freedom, from tables
  EXPECT_NEAR(fit.upper(0) - fit.estimates(0), 2.178813 * 2.7070075241, 1e-4);
  EXPECT_FALSE(fit.chi_square.has_value());
}

/// A straight problem with known sigma and a prior against the normal equations.
TEST(CurveFit, WeighsSigmaAndPriorsLikeTheNormalEquations) {
  Curve data;
  data.x = {1.0, 2.0, 3.0, 4.0};
  data.y = {1.4, 3.7, 8.0, 12.1};
  data.sigma = {0.1, 0.2, 0.4, 0.3};
  FormulaModel model = parabola(data.x);
  CurveFitOptions options;
  options.free = {{.parameter = kappa, .start = 2.0, .prior = Prior{.mean = 1.0, .deviation = 0.2}},
                  {.parameter = lambda, .start = 1.0}};
  const CurveFit fit = fit_curves({data}, {&model}, options);

  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < 4; ++i) {
    const double x = data.x[i];
    const Eigen::Vector2d row = Eigen::Vector2d(x, x * x) / data.sigma[i];
    normal += row * row.transpose();
    right += row * data.y[i] / data.sigma[i];
  }
  normal(0, 0) += 1.0 / 0.04;
  right(0) += 1.0 / 0.04;
  const Eigen::Vector2d expected = normal.inverse() * right;
  const Eigen::Matrix2d covariance = normal.inverse();
  EXPECT_LT((fit.estimates - expected).norm(), 1e-9);
  EXPECT_LT((fit.covariance - covariance).norm(), 1e-9 * covariance.norm());
  EXPECT_NEAR(fit.correlation(0, 1),
              covariance(0, 1) / std::sqrt(covariance(0, 0) * covariance(1, 1)), 1e-9);
  EXPECT_NEAR(fit.upper(1) - fit.estimates(1), 1.959964 * std::sqrt(covariance(1, 1)), 1e-6);
  EXPECT_EQ(fit.degrees_of_freedom, 3);
  double chi_square = std::pow((expected(0) - 1.0) / 0.2, 2);
  for (std::size_t i = 0; i < 4; ++i) {
    const double x = data.x[i];
    chi_square += std::pow((expected(0) * x + expected(1) * x * x - data.y[i]) / data.sigma[i], 2);
  }
  EXPECT_NEAR(fit.chi_square.value(), chi_square, 1e-9);
}

/// Without sigma a prior is weighed against the residuals' own deviation s: the normal equations of
/// XᵀX/s² and the prior, where s² = sum of squares/(n + 1 - 2), solved here by turns.
TEST(CurveFit, WithoutSigmaPriorsAreWeighedAgainstTheScatter) {
  Curve data;
  for (int i = 1; i <= 12; ++i) {
    const double x = 0.25 * i;
    data.x.push_back(x);
    data.y.push_back(1.5 * x + 0.8 * x * x + 0.05 * (i % 3 - 1));
  }
  FormulaModel model = parabola(data.x);
  CurveFitOptions options;
  options.free = {
      {.parameter = kappa, .start = 2.0, .prior = Prior{.mean = 1.4, .deviation = 0.02}},
      {.parameter = lambda, .start = 1.0}};
  const CurveFit fit = fit_curves({data}, {&model}, options);

  const Index count = Index(data.x.size());
  MatrixXd design(count, 2);
  for (Index i = 0; i < count; ++i)
    design.row(i) << data.x[std::size_t(i)], std::pow(data.x[std::size_t(i)], 2);
  const VectorXd y = VectorXd::Map(data.y.data(), count);
  double s = 1.0;
  Eigen::Vector2d expected;
  Eigen::Matrix2d normal;
  for (int turn = 0; turn < 200; ++turn) {
    normal = design.transpose() * design / (s * s);
    Eigen::Vector2d right = design.transpose() * y / (s * s);
    normal(0, 0) += 1.0 / (0.02 * 0.02);
    right(0) += 1.4 / (0.02 * 0.02);
    expected = normal.inverse() * right;
    s = (y - design * expected).norm() / std::sqrt(double(count + 1 - 2));
  }
  EXPECT_LT((fit.estimates - expected).norm(), 1e-4 * expected.norm());
  EXPECT_NEAR(fit.residual_deviation, s, 1e-3 * s);
  EXPECT_LT((fit.covariance - normal.inverse()).norm(), 2e-3 * normal.inverse().norm());
  EXPECT_FALSE(fit.chi_square.has_value());
  EXPECT_GT(std::abs(expected(0) - 1.4), 0.005) << "both count";
  EXPECT_LT(std::abs(expected(0) - 1.4), std::abs(1.5 - 1.4) - 0.005);
}

/// Two degrees of freedom: P = exp(-chi²/2). One: t is Cauchy, tan(0.475 pi).
TEST(CurveFit, QuantilesMeetClosedForms) {
  EXPECT_NEAR(chi_square_above(3.0, 2), std::exp(-1.5), 1e-12);
  EXPECT_NEAR(student_95(1), std::tan(0.475 * std::numbers::pi), 1e-9);
  EXPECT_NEAR(student_95(1000000), normal_95(), 1e-5);
}

/// Least squares with p slopes and n values: their squares over the true variance are chi-square of
/// n - p, those of new values about the fit n + p in the mean, and 1/chi-square of f has the mean
/// 1/(f - 2). With the deviation by n, -2 log-likelihood of new values exceeds that of the fitted
/// ones by n (n + p)/(n - p - 2) - n.
TEST(CurveFit, TheCriterionTakesOffWhatTheFitGains) {
  for (const double n : {6.0, 12.0, 200.0})
    for (const double p : {1.0, 3.0})
      EXPECT_NEAR(aicc_penalty(n, p + 1.0), n * (n + p) / (n - p - 2.0) - n, 1e-11 * n);
  EXPECT_EQ(aicc_penalty(4.0, 3.0), std::numeric_limits<double>::infinity());
}

/// Data that ask for nu = -0.16 where nu >= 0 is all a model knows: the least squares along E = 2G,
/// by hand, and not wherever the search first met the wall.
TEST(CurveFit, TheEndOfPoissonsRatioIsABound) {
  Curve data;
  data.x = {1.0, 2.0};
  data.y = {2300.0, 1373.0};  // E and G themselves
  data.sigma = {10.0, 10.0};
  FormulaModel model([](const VectorXd& p) {
    if (p(0) < 2.0 * p(1) * (1.0 - 1e-12))
      throw meshes::InvalidInput({"nu", "", "nu >= 0", "raise E"});
    return CurveSlopes{p, MatrixXd::Identity(2, 2)};
  });
  CurveFitOptions options = e_and_g();
  options.lowest_poissons_ratio = 0.0;
  const CurveFit fit = fit_curves({data}, {&model}, options);
  const double g = (2.0 * 2300.0 + 1373.0) / 5.0;
  EXPECT_NEAR(fit.estimates(1), g, 1e-5 * g);
  EXPECT_NEAR(fit.estimates(0), 2.0 * g, 1e-5 * g);
  EXPECT_TRUE(fit.at_bound[0]);
}

/// Sigma stated five times too small: chi-square is 25 times what it should be, and the intervals
/// become those of a fit that does not know sigma, but for Student's t.
TEST(CurveFit, IntervalsGrowWhereSigmaDoesNotExplainTheResiduals) {
  Curve data;
  for (int i = 1; i <= 40; ++i) {
    data.x.push_back(0.1 * i);
    data.y.push_back(0.2 * i + 0.1 * std::cos(11.0 * i));
  }
  FormulaModel model = parabola(data.x);
  CurveFitOptions options;
  options.free = {{.parameter = kappa, .start = 1.0},
                  {.parameter = lambda, .start = 0.0, .scale = 1.0}};
  const CurveFit unknown = fit_curves({data}, {&model}, options);
  EXPECT_EQ(unknown.birge_ratio, 1.0);
  data.sigma.assign(40, unknown.residual_deviation / 5.0);
  const CurveFit wrong = fit_curves({data}, {&model}, options);
  EXPECT_NEAR(wrong.birge_ratio, 5.0, 1e-6);
  EXPECT_NEAR((wrong.upper(0) - wrong.estimates(0)) / normal_95(),
              (unknown.upper(0) - unknown.estimates(0)) / student_95(38), 1e-6);
  data.sigma.assign(40, unknown.residual_deviation);
  EXPECT_EQ(fit_curves({data}, {&model}, options).birge_ratio, 1.0);
}

TEST(CurveFit, RobustLossForgivesAnOutlier) {
  Curve data;
  for (int i = 1; i <= 12; ++i) {
    data.x.push_back(0.25 * i);
    data.y.push_back(0.5 * i + 0.03 * std::cos(7.0 * i));  // slopes 2 and 0
    data.sigma.push_back(0.03);
  }
  data.y[6] += 1.0;
  FormulaModel model = parabola(data.x);
  CurveFitOptions options;
  options.free = {{.parameter = kappa, .start = 1.0},
                  {.parameter = lambda, .start = 0.0, .scale = 1.0}};
  const CurveFit plain = fit_curves({data}, {&model}, options);
  options.robust_width = 1.0;
  const CurveFit robust = fit_curves({data}, {&model}, options);
  const Eigen::Vector2d truth(2.0, 0.0);
  EXPECT_GT((plain.estimates - truth).norm(), 4.0 * (robust.estimates - truth).norm());
  EXPECT_FALSE(robust.chi_square.has_value());
  EXPECT_GT(plain.chi_square.value(), 100.0);
  EXPECT_LT(plain.chi_square_probability.value(), 1e-10);

  // At the minimum the loss's slope vanishes: sum of r/sqrt(1 + r²/w²) dr/dp = 0.
  const CurveSlopes at = model.evaluate(robust.estimates);
  VectorXd pull = -robust.residuals[0] / 0.03;
  for (double& r : pull) r /= std::sqrt(1.0 + r * r);
  const VectorXd gradient = at.jacobian.transpose() * pull;
  EXPECT_LT(gradient.norm(), 1e-4 * at.jacobian.norm());
}

TEST(CurveFit, HoldsBoundsAndSaysSo) {
  Curve data;
  data.x = {1.0, 2.0, 3.0};
  data.y = {1.0, 2.1, 2.9};
  FormulaModel model = parabola(data.x);
  CurveFitOptions options;
  options.free = {{.parameter = k1, .start = 0.5, .upper = 0.6}, {.parameter = k2, .start = 1.0}};
  const CurveFit fit = fit_curves({data}, {&model}, options);
  EXPECT_NEAR(fit.estimates(0), 0.6, 1e-9);
  EXPECT_TRUE(fit.at_bound[0]);
  EXPECT_FALSE(fit.at_bound[1]);
}

TEST(CurveFit, RecoversEAndGExactly) {
  const CurveFit fit =
      fit_presses({synthetic(ContactMode::frictionless, depths, 0.0, 0, false),
                   synthetic(ContactMode::stick, depths, 0.0, 0, false)},
                  {press(ContactMode::frictionless), press(ContactMode::stick)}, e_and_g());
  EXPECT_NEAR(fit.estimates(0) / rubber.youngs_modulus, 1.0, 1e-7);
  EXPECT_NEAR(fit.estimates(1) / rubber.shear_modulus, 1.0, 1e-7);
  EXPECT_TRUE(fit.unidentifiable.empty());
  EXPECT_EQ(fit.degrees_of_freedom, 10);
}

/// A second rubber, of nu near 0.1, meets both curves within 1 %; between it and the true one, at
/// nu near 0.25, the misfit has a ridge.
TEST(CurveFit, OfSeveralMinimaTheLeastIsReported) {
  CurveFitOptions options = e_and_g();
  options.free[0].start = 4600.0;
  options.free[1].start = 2100.0;
  options.other_starts = {Eigen::Vector2d(4500.0, 1540.0)};
  const CurveFit fit =
      fit_presses({synthetic(ContactMode::frictionless, {4e-4, 8e-4, 12e-4}, 0.0, 0, false),
                   synthetic(ContactMode::stick, {4e-4, 8e-4, 12e-4}, 0.0, 0, false)},
                  {press(ContactMode::frictionless), press(ContactMode::stick)}, options);
  EXPECT_NEAR(fit.estimates(0) / rubber.youngs_modulus, 1.0, 1e-7);
  ASSERT_EQ(fit.minima.size(), 2u);
  EXPECT_GT(fit.minima[0].loss, 1e6 * fit.minima[1].loss);
}

/// The same pair of rubbers, of which bounds leave the true one: on this side of the ridge the
/// search ends at the bound.
TEST(CurveFit, WhereASearchEndsAtABoundOfPoissonsRatioStartsInReserveAreTried) {
  CurveFitOptions options = e_and_g();
  options.free[0].start = 4600.0;
  options.free[1].start = 1980.0;
  options.lowest_poissons_ratio = 0.15;
  const std::vector<Curve> curves = {
      synthetic(ContactMode::frictionless, {4e-4, 8e-4, 12e-4}, 0.0, 0, false),
      synthetic(ContactMode::stick, {4e-4, 8e-4, 12e-4}, 0.0, 0, false)};
  const std::vector<PressSetup> presses = {press(ContactMode::frictionless),
                                           press(ContactMode::stick)};
  ASSERT_NEAR(fit_presses(curves, presses, options).poissons_ratio_bound.value(), 0.15, 1e-9);
  // The second is not asked any more.
  options.reserve_starts = {Eigen::Vector2d(4500.0, 1540.0), Eigen::Vector2d(4500.0, 1600.0)};
  const CurveFit fit = fit_presses(curves, presses, options);
  EXPECT_NEAR(fit.estimates(0) / rubber.youngs_modulus, 1.0, 1e-7);
  EXPECT_FALSE(fit.poissons_ratio_bound);
  EXPECT_EQ(fit.minima.size(), 2u);
}

/// Each bound fails by chance in one of 10^4 runs; the seeds are fixed.
TEST(CurveFit, NoiseStaysWithinItsStandardErrors) {
  const CurveFit fit =
      fit_presses({synthetic(ContactMode::frictionless, depths, 0.01, 1, true),
                   synthetic(ContactMode::stick, depths, 0.01, 2, true)},
                  {press(ContactMode::frictionless), press(ContactMode::stick)}, e_and_g());
  EXPECT_LT(std::abs(fit.estimates(0) - rubber.youngs_modulus), 4.0 * fit.standard_errors(0));
  EXPECT_LT(std::abs(fit.estimates(1) - rubber.shear_modulus), 4.0 * fit.standard_errors(1));
  EXPECT_LT(fit.standard_errors(0), 0.03 * rubber.youngs_modulus);
  EXPECT_TRUE(fit.unidentifiable.empty());
  EXPECT_GT(fit.chi_square_probability.value(), 1e-4);
  EXPECT_LT(fit.chi_square_probability.value(), 1.0 - 1e-4);
}

/// A sphere on a half-space knows E/(1 - nu²) = 4 G²/(4 G - E) alone, whose relative slopes are
/// E/(4G - E) > 0 by E and 1 minus that, < 0, by G: E and G that rise together cancel.
TEST(CurveFit, OneShallowCurveCannotSeparateEFromG) {
  const Curve curve = synthetic(ContactMode::frictionless, shallow, 0.01, 3, true);
  CurveFitOptions options = e_and_g();
  // A lattice as fits ask it: at few Poisson's ratios, wherever the search goes along the valley.
  LatticeByRatio by_ratio(with_samples(press(ContactMode::frictionless), curve.x));
  const auto solver = [&](const std::vector<double>& ratios) {
    std::vector<VectorXd> values;
    for (const double ratio : ratios)
      values.push_back(by_ratio.evaluate(VectorXd::Constant(1, ratio)).value);
    return values;
  };
  ScaledModel model(solver, parameters_in(options), rubber);
  const CurveFit open = fit_curves({curve}, {&model}, options);
  ASSERT_EQ(open.unidentifiable.size(), 1u) << open.singular_values.transpose();
  const Direction& weak = open.unidentifiable[0];
  EXPECT_LT(weak.relative_singular_value, 0.02);
  EXPECT_GT(weak.changes(0) * weak.changes(1), 0.0);
  EXPECT_NE(weak.statement.find("youngs_modulus"), std::string::npos) << weak.statement;
  EXPECT_GT(open.correlation(0, 1), 0.98);

  options.free[0].prior = Prior{rubber.youngs_modulus, 0.02 * rubber.youngs_modulus};
  const CurveFit closed = fit_curves({curve}, {&model}, options);
  EXPECT_TRUE(closed.unidentifiable.empty());
  ASSERT_EQ(closed.only_from_priors.size(), 1u);
  EXPECT_LT(closed.standard_errors(1), 0.06 * rubber.shear_modulus);
  EXPECT_LT(std::abs(closed.estimates(1) - rubber.shear_modulus), 4.0 * closed.standard_errors(1));
}

/// y = E x² + 4 G x, data of E = 3.06 G: the edge nu = 1/2 is the answer, and the best G on it is
/// found, from any start.
TEST(CurveFit, DataBeyondTheIncompressibleEndAtNuOneHalf) {
  Curve data;
  for (int i = 1; i <= 8; ++i) {
    data.x.push_back(0.1 * i);
    data.y.push_back(4.0 * 0.1 * i + 3.06 * std::pow(0.1 * i, 2));
    data.sigma.push_back(0.01);
  }
  FormulaModel model([&](const VectorXd& p) {
    if (p(0) >= 3.0 * p(1)) throw meshes::InvalidInput({"G", "", "G must exceed E/3", ""});
    MatrixXd design(8, 2);
    for (Index i = 0; i < 8; ++i) {
      const double x = data.x[std::size_t(i)];
      design.row(i) << x * x, 4.0 * x;
    }
    return CurveSlopes{design * p, design};
  });
  for (const auto& [e, g] : {std::pair{2.0, 1.0}, {2.99, 1.0}, {1.0, 2.0}, {5.0, 1.7}}) {
    CurveFitOptions options;
    options.free = {{.parameter = youngs_modulus, .start = e},
                    {.parameter = shear_modulus, .start = g}};
    const CurveFit fit = fit_curves({data}, {&model}, options);
    // On the line E = r G the best G is that of y against (r x² + 4 x).
    const double ratio = 3.0 / (1.0 + 1e-4);
    double above = 0.0, below = 0.0;
    for (std::size_t i = 0; i < 8; ++i) {
      const double f = ratio * data.x[i] * data.x[i] + 4.0 * data.x[i];
      above += f * data.y[i];
      below += f * f;
    }
    EXPECT_NEAR(fit.estimates(1), above / below, 1e-9) << e << " " << g;
    EXPECT_NEAR(fit.estimates(0), ratio * above / below, 1e-9);
    EXPECT_TRUE(fit.at_bound[0]);
    EXPECT_FALSE(fit.at_bound[1]);
    EXPECT_LT(fit.evaluations, 60);
  }
}

/// The same minimum from other starts, to 1e-6 of a standard error, kinks of F(p) or not.
TEST(CurveFit, EstimatesDoNotDependOnTheStart) {
  const std::vector<Curve> curves = {synthetic(ContactMode::frictionless, shallow, 0.01, 2, true)};
  CurveFitOptions options = e_and_g();
  const CurveFit fit = fit_presses(curves, {press(ContactMode::frictionless)}, options);
  options.free[0].start = rubber.youngs_modulus;
  options.free[1].start = rubber.shear_modulus;
  const CurveFit other = fit_presses(curves, {press(ContactMode::frictionless)}, options);
  const VectorXd shift = (fit.estimates - other.estimates).cwiseQuotient(fit.standard_errors);
  EXPECT_LT(shift.cwiseAbs().maxCoeff(), 1e-6);
}

TEST(CurveFit, ThreadsDoNotChangeAnything) {
  const std::vector<double> at = {4e-4, 8e-4};
  const std::vector<Curve> curves = {synthetic(ContactMode::frictionless, at, 0.01, 1, true),
                                     synthetic(ContactMode::stick, at, 0.01, 2, true),
                                     synthetic(ContactMode::frictionless, at, 0.01, 3, true)};
  const std::vector<PressSetup> conditions = {press(ContactMode::frictionless),
                                              press(ContactMode::stick),
                                              press(ContactMode::frictionless)};
  CurveFitOptions options = e_and_g();
  const CurveFit serial = fit_presses(curves, conditions, options);
  options.threads = 3;
  const CurveFit three = fit_presses(curves, conditions, options);
  EXPECT_EQ(serial.estimates, three.estimates);
  EXPECT_EQ(serial.covariance, three.covariance);
  EXPECT_EQ(serial.evaluations, three.evaluations);
}

/// One model of two curves is evaluated once per point; of errors the first curve's is told.
TEST(CurveFit, EvaluatesEachModelOnceAndTellsTheFirstError) {
  Curve data;
  data.x = {1.0, 2.0, 3.0};
  data.y = {1.0, 2.1, 2.9};
  int calls = 0;
  FormulaModel inner = parabola(data.x);
  FormulaModel model([&](const VectorXd& p) {
    ++calls;
    return inner.evaluate(p);
  });
  CurveFitOptions options;
  options.free = {{.parameter = kappa, .start = 2.0}, {.parameter = lambda, .start = 1.0}};
  options.threads = 2;
  std::vector<int> told;
  options.progress = [&](int evaluations, double loss) {
    told.push_back(evaluations);
    return std::isfinite(loss);
  };
  const CurveFit fit = fit_curves({data, data}, {&model, &model}, options);
  EXPECT_EQ(calls, fit.evaluations);
  ASSERT_EQ(int(told.size()), calls);
  EXPECT_EQ(told.back(), calls);
  FormulaModel first([](const VectorXd&) -> CurveSlopes { throw meshes::NotConverged("first"); });
  FormulaModel second([](const VectorXd&) -> CurveSlopes { throw meshes::NotConverged("second"); });
  try {
    fit_curves({data, data}, {&first, &second}, options);
    ADD_FAILURE() << "no error";
  } catch (const meshes::NotConverged& error) {
    EXPECT_STREQ(error.what(), "first");
  }
}

namespace {

/// y = p² x by its tangent, drawn where a search has ended.
class Tangent final : public ForwardModel {
 public:
  explicit Tangent(VectorXd x) : x_(std::move(x)) {}
  CurveSlopes evaluate(const VectorXd& p) override {
    return {(2.0 * p(0) - at_) * at_ * x_, 2.0 * at_ * x_};
  }
  bool refine(const VectorXd& p) override {
    const bool apart = std::abs(p(0) - at_) > 1e-12;
    at_ = p(0);
    ++drawn;
    return apart;
  }
  int drawn = 0;

 private:
  VectorXd x_;
  double at_ = 1.0;
};

}  // namespace

/// Searches by tangents are Heron's rule for a root; one model serves both curves and learns once.
TEST(CurveFit, SearchesAnewWhereModelsHaveLearnt) {
  const Curve data{.name = "", .x = {1.0, 2.0}, .y = {2.0, 4.0}, .sigma = {}};
  Tangent model(Eigen::Vector2d(1.0, 2.0));
  CurveFitOptions options;
  options.free = {{.parameter = kappa, .start = 1.0}};
  const CurveFit fit = fit_curves({data, data}, {&model, &model}, options);
  EXPECT_NEAR(fit.estimates(0), std::numbers::sqrt2, 1e-12);
  EXPECT_EQ(model.drawn, 6) << "1.5, 1.4167, 1.414216, ...: digits double";
}

TEST(CurveFit, IsInterruptedBetweenAndWithinEvaluations) {
  const std::vector<Curve> curves = {synthetic(ContactMode::stick, {4e-4, 8e-4}, 0.01, 1, true)};
  CurveFitOptions options = e_and_g();
  options.progress = [](int evaluations, double) { return evaluations < 2; };
  EXPECT_THROW(fit_presses(curves, {press(ContactMode::stick)}, options), meshes::Interrupted);
  options.progress = [](int, double) {
    ADD_FAILURE() << "no press may be finished";
    return true;
  };
  int asked = 0;
  EXPECT_THROW(
      fit_presses(curves, {press(ContactMode::stick)}, options, [&] { return ++asked < 3; }),
      meshes::Interrupted);
  EXPECT_EQ(asked, 3);
}

/// The moduli know k1 + 2 k2 + 4/3 k3 and k2 + 4/3 k3 alone: (4/3, -4/3, 1) is open.
TEST(CurveFit, SaysWhichCombinationOfSpringsIsOpen) {
  Curve data;
  data.x = {1.0, 2.0, 3.0, 4.0};
  data.y = {1.0, 2.0, 3.0, 4.0};
  data.sigma = {0.01, 0.01, 0.01, 0.01};
  FormulaModel model([&](const VectorXd& k) {
    MatrixXd design(4, 3);
    for (Index i = 0; i < 4; ++i) {
      const double x = data.x[std::size_t(i)];
      design.row(i) = x * Eigen::RowVector3d(1.0, 2.0, 4.0 / 3.0) +
                      x * x * Eigen::RowVector3d(0.0, 1.0, 4.0 / 3.0);
    }
    return CurveSlopes{design * k, design};
  });
  CurveFitOptions options;
  options.free = {{.parameter = k1, .start = 2.0},
                  {.parameter = k2, .start = 3.0},
                  {.parameter = k3, .start = 1.0}};
  const CurveFit fit = fit_curves({data}, {&model}, options);
  ASSERT_EQ(fit.unidentifiable.size(), 1u);
  const std::string& statement = fit.unidentifiable[0].statement;
  const bool plus = statement.find("k1 + 1 N/m, k2 - 1 N/m, k3 + 0.75 N/m") != std::string::npos;
  const bool minus = statement.find("k1 - 1 N/m, k2 + 1 N/m, k3 - 0.75 N/m") != std::string::npos;
  EXPECT_TRUE(plus || minus) << statement;
  EXPECT_NE(statement.find("keeps k2 + 4/3 k3 (the shear modulus) and k1 + 2 k2 + 4/3 k3"),
            std::string::npos)
      << statement;
}

TEST(CurveFit, BadInputIsRefusedWithItsRule) {
  Curve good;
  good.x = {1e-4, 2e-4, 3e-4};
  good.y = {1.0, 2.0, 3.0};
  const auto said = [&](const Curve& curve, CurveFitOptions options = e_and_g()) {
    return refusal([&] { fit_presses({curve}, {press(ContactMode::frictionless)}, options); });
  };
  const auto expect = [](const std::string& text, const char* rule) {
    EXPECT_NE(text.find(rule), std::string::npos) << text;
  };
  Curve bad = good;
  bad.x.clear();
  bad.y.clear();
  expect(said(bad), "a curve needs points");
  bad = good;
  bad.x[2] = 2e-4;
  expect(said(bad), "increasing");
  bad = good;
  bad.x[1] = std::nan("");
  expect(said(bad), "finite, positive and increasing");
  bad = good;
  bad.y[1] = std::nan("");
  expect(said(bad), "values must be finite");
  bad = good;
  bad.y.pop_back();
  expect(said(bad), "as many values as abscissae");
  bad = good;
  bad.sigma = {0.1, -0.1, 0.1};
  expect(said(bad), "standard deviations must be finite and positive");
  bad = good;
  bad.sigma = {0.1, 0.1};
  expect(said(bad), "one standard deviation per value");
  bad = good;
  bad.x.resize(2);
  bad.y.resize(2);
  expect(said(bad), "as many as free parameters");
  expect(refusal([&] {
           fit_presses({good}, {press(ContactMode::frictionless, ModelKind::central)}, e_and_g());
         }),
         "central model does not depend on it");
  bad = good;
  bad.x[2] = 1.0;
  expect(said(bad), "depth");

  CurveFitOptions options = e_and_g();
  options.free[0].start = -1.0;
  options.free[0].lower = 0.0;
  expect(said(good, options), "within its bounds");
  options = e_and_g();
  options.free[0].parameter = k1;
  expect(said(good, options), "described in one way");
  options = e_and_g();
  options.free[1].parameter = youngs_modulus;
  expect(said(good, options), "named once");
  expect(refusal([&] { fit_presses({}, {}, e_and_g()); }), "at least one curve");
  options = e_and_g();
  options.other_starts = {Eigen::VectorXd::Constant(1, 4000.0)};
  expect(said(good, options), "for every free parameter");
  // Each is well formed, but E >= 3G is no rubber.
  options = e_and_g();
  options.free[0].start = 3.0 * options.free[1].start;
  expect(said(good, options), "G must exceed E/3");
}
