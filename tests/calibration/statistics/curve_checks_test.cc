/// Checks of a fit against closed forms of linear least squares.
#include "calibration/statistics/curve_checks.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "tests/calibration/fit_fixtures.h"

using namespace fit_fixtures;

namespace {

/// x, x², x³: as many as columns.
MatrixXd powers(const std::vector<double>& x, Index columns) {
  MatrixXd design(Index(x.size()), columns);
  for (Index i = 0; i < design.rows(); ++i)
    for (Index j = 0; j < columns; ++j) design(i, j) = std::pow(x[std::size_t(i)], j + 1);
  return design;
}

FormulaModel linear(const MatrixXd& design) {
  return FormulaModel([design](const VectorXd& p) { return CurveSlopes{design * p, design}; });
}

Curve curve_of(const std::vector<double>& x, const VectorXd& y, double sigma) {
  Curve curve;
  curve.x = x;
  curve.y.assign(y.begin(), y.end());
  if (sigma > 0.0) curve.sigma.assign(x.size(), sigma);
  return curve;
}

const std::vector<double> abscissae = {0.2, 0.5, 0.7, 1.0, 1.2, 1.5, 1.9, 2.0};

VectorXd wiggle(double size) {
  VectorXd error(8);
  for (Index i = 0; i < 8; ++i) error(i) = size * std::cos(5.0 * double(i));
  return error;
}

CurveFitOptions free_parameters(const std::vector<MaterialParameter>& parameters) {
  CurveFitOptions options;
  for (const MaterialParameter parameter : parameters)
    options.free.push_back({.parameter = parameter, .start = 1.0});
  return options;
}

}  // namespace

TEST(CurveChecks, LeaveOneOutMeetsTheNormalEquations) {
  const MatrixXd design = powers(abscissae, 2);
  std::vector<Curve> curves;
  std::vector<FormulaModel> models(3, linear(design));
  std::vector<ForwardModel*> addresses;
  for (int c = 0; c < 3; ++c) {
    const VectorXd y = design * Eigen::Vector2d(2.0 + 0.1 * c, 0.5) + wiggle(0.02 * (c + 1));
    curves.push_back(curve_of(abscissae, y, 0.05 + 0.02 * c));
    addresses.push_back(&models[std::size_t(c)]);
  }
  const CurveFitOptions options = free_parameters({kappa, lambda});
  const CurveFit fit = fit_curves(curves, addresses, options);
  const auto left = leave_one_out(curves, addresses, options, fit);
  ASSERT_EQ(left.size(), 3u);
  for (std::size_t out = 0; out < 3; ++out) {
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    for (std::size_t c = 0; c < 3; ++c) {
      if (c == out) continue;
      const double weight = std::pow(curves[c].sigma[0], -2);
      normal += weight * design.transpose() * design;
      right += weight * design.transpose() * Eigen::Map<const VectorXd>(curves[c].y.data(), 8);
    }
    const Eigen::Vector2d expected = normal.ldlt().solve(right);
    const VectorXd y = Eigen::Map<const VectorXd>(curves[out].y.data(), 8);
    EXPECT_LT((left[out].estimates - expected).norm(), 1e-9);
    EXPECT_LT((left[out].residuals - (y - design * expected)).norm(), 1e-9);
    EXPECT_NEAR(left[out].worst_relative_error,
                (y - design * expected).cwiseQuotient(y).cwiseAbs().maxCoeff(), 1e-8);
    EXPECT_TRUE(left[out].failure.empty());
  }
  EXPECT_NE(refusal([&] {
              leave_one_out({curves[0]}, {addresses[0]}, options, fit);
            }).find("another remains"),
            std::string::npos);
}

/// What is left may be too little for a fit; the others still are done.
TEST(CurveChecks, LeaveOneOutSaysWhereNoFitIsLeft) {
  const std::vector<double> abscissa = {1.0};
  FormulaModel many = linear(powers(abscissae, 2)), single = linear(powers(abscissa, 2));
  const std::vector<Curve> curves = {
      curve_of(abscissae, powers(abscissae, 2) * Eigen::Vector2d(2.0, 0.5), 0.1),
      curve_of(abscissa, VectorXd::Constant(1, 2.6), 0.1)};
  const CurveFitOptions options = free_parameters({kappa, lambda});
  const CurveFit fit = fit_curves(curves, {&many, &single}, options);
  const auto left = leave_one_out(curves, {&many, &single}, options, fit);
  EXPECT_NE(left[0].failure.find("as many as free parameters"), std::string::npos);
  EXPECT_TRUE(left[1].failure.empty());
  EXPECT_NEAR(left[1].residuals(0), 0.1, 1e-9);
}

/// Of a linear model chi-square is a paraboloid: the profile is δᵀ (their covariance)⁻¹ δ, sigma
/// known, estimated, or with a prior.
TEST(CurveChecks, ProfileOfALinearModelIsItsEllipse) {
  const MatrixXd design = powers(abscissae, 3);
  FormulaModel model = linear(design);
  const VectorXd y = design * Eigen::Vector3d(3.0, -1.0, 2.0) + wiggle(0.05);
  for (const int kind : {0, 1, 2}) {
    const Curve curve = curve_of(abscissae, y, kind == 0 ? 0.0 : 0.05);
    CurveFitOptions options = free_parameters({kappa, lambda, kappa});
    if (kind == 2) options.free[0].prior = Prior{.mean = 2.5, .deviation = 0.1};
    const CurveFit fit = fit_curves({curve}, {&model}, options);
    const Profile profile = profile_likelihood({curve}, {&model}, options, fit, 2, 0, 5);
    EXPECT_NEAR(profile.first_values(4), fit.estimates(2) + 3.0 * fit.standard_errors(2), 1e-12);
    const std::vector<Index> reversed = {2, 0};
    const Eigen::Matrix2d covariance = fit.covariance(reversed, reversed);
    for (Index i = 0; i < 5; ++i)
      for (Index j = 0; j < 5; ++j) {
        const Eigen::Vector2d step(profile.first_values(i) - fit.estimates(2),
                                   profile.second_values(j) - fit.estimates(0));
        const double expected = step.dot(covariance.inverse() * step);
        EXPECT_NEAR(profile.increase(i, j), expected, 1e-7 * (1.0 + expected)) << kind;
      }
  }
}

/// Of a linear model the interval of the profile is that of the covariance, also where the model is
/// known to err: with sigma that is part of chi-square, without it comes through.
TEST(CurveChecks, ProfileIntervalOfALinearModelIsThatOfItsCovariance) {
  const MatrixXd design = powers(abscissae, 2);
  FormulaModel model = linear(design);
  const VectorXd y = design * Eigen::Vector2d(3.0, -1.0) + wiggle(0.02);
  for (const double sigma : {0.0, 0.02})
    for (const double model_error : {0.0, 0.01, 0.3}) {
      const Curve curve = curve_of(abscissae, y, sigma);
      CurveFitOptions options = free_parameters({kappa, lambda});
      if (model_error > 0.0)
        options.model_covariance = model_error * model_error * y * y.transpose();
      const CurveFit fit = fit_curves({curve}, {&model}, options);
      for (Index i = 0; i < 2; ++i) {
        const ProfileInterval own =
            profile_interval({curve}, {&model}, options, fit, std::size_t(i), 2.0);
        const double error = fit.standard_errors(i);
        EXPECT_NEAR(own.lower, fit.estimates(i) - 2.0 * error, 3e-3 * error)
            << sigma << ' ' << model_error;
        EXPECT_NEAR(own.upper, fit.estimates(i) + 2.0 * error, 3e-3 * error)
            << sigma << ' ' << model_error;
      }
    }
}

/// Bounds cut the grid off; a model without answer leaves a hole.
TEST(CurveChecks, ProfileKeepsToBoundsAndLeavesHoles) {
  const MatrixXd design = powers(abscissae, 2);
  FormulaModel model([&](const VectorXd& p) {
    if (p(0) > 2.02) throw meshes::NotConverged("too far");
    return CurveSlopes{design * p, design};
  });
  const Curve curve = curve_of(abscissae, design * Eigen::Vector2d(2.0, 0.5), 0.05);
  CurveFitOptions options = free_parameters({kappa, lambda});
  options.free[1].upper = 1.0;
  options.free[1].lower = 0.49;
  const CurveFit fit = fit_curves({curve}, {&model}, options);
  const Profile profile = profile_likelihood({curve}, {&model}, options, fit, 0, 1);
  EXPECT_EQ(profile.second_values(0), 0.49);
  EXPECT_LT(profile.second_values(8), 1.0);
  EXPECT_TRUE(std::isnan(profile.increase(8, 0)));
  EXPECT_FALSE(std::isnan(profile.increase(0, 0)));
  EXPECT_NE(refusal([&] {
              profile_likelihood({curve}, {&model}, options, fit, 1, 1);
            }).find("two different"),
            std::string::npos);
}

/// A model that lacks the cube of the truth: its estimates lie off by what influence says.
TEST(CurveChecks, BiasIsWhatAWrongModelMakes) {
  const MatrixXd design = powers(abscissae, 2);
  FormulaModel model = linear(design);
  const VectorXd truth = Eigen::Vector2d(2.0, 0.5);
  const VectorXd cube = 0.03 * powers(abscissae, 3).col(2);
  for (const bool with_prior : {false, true}) {
    CurveFitOptions options = free_parameters({kappa, lambda});
    if (with_prior) options.free[1].prior = Prior{.mean = 0.5, .deviation = 0.02};
    const Curve curve = curve_of(abscissae, design * truth + cube, 0.05);
    const CurveFit fit = fit_curves({curve}, {&model}, options);
    const VectorXd bias = fit.influence * cube;
    EXPECT_LT((fit.estimates - truth - bias).norm(), 1e-8 * bias.norm());
    EXPECT_GT(bias.norm(), 0.01);
  }
}

/// Without sigma and with a robust loss the rows are those that the estimates follow, too: a small
/// error moves a nonlinear fit by the bias, up to its square.
TEST(CurveChecks, BiasOfANonlinearRobustFitIsOfSecondOrder) {
  FormulaModel model([](const VectorXd& p) {
    CurveSlopes result{VectorXd(8), MatrixXd(8, 2)};
    for (Index i = 0; i < 8; ++i) {
      const double x = abscissae[std::size_t(i)], decay = std::exp(-p(1) * x);
      result.value(i) = p(0) * (1.0 - decay);
      result.jacobian.row(i) << 1.0 - decay, p(0) * x * decay;
    }
    return result;
  });
  CurveFitOptions options = free_parameters({kappa, lambda});
  for (const double width : {0.0, 3.0}) {
    options.robust_width = width;
    const double sigma = width > 0.0 ? 0.01 : 0.0;
    const auto off = [&](double size) {
      const VectorXd y = model.evaluate(Eigen::Vector2d(2.0, 0.8)).value;
      const VectorXd error = wiggle(size);
      const CurveFit fit = fit_curves({curve_of(abscissae, y + error, sigma)}, {&model}, options);
      const VectorXd shift = fit.estimates - Eigen::Vector2d(2.0, 0.8);
      return (shift - fit.influence * error).norm();
    };
    const double order = std::log2(off(2e-3) / off(1e-3));
    EXPECT_GT(order, 1.8) << width;
  }
}

/// Forces are homogeneous in E and G: at the true Poisson's ratio the scale is exact.
TEST(CurveChecks, ScaledStartsFindTheRubberOfAPoissonsRatio) {
  const std::vector<double> at = {3e-4, 6e-4, 9e-4};
  const Curve curve = synthetic(ContactMode::frictionless, at, 0.0, 1, false);
  LatticeForwardModel model(with_samples(press(ContactMode::frictionless), at),
                            {youngs_modulus, shear_modulus});
  CurveFitOptions options = e_and_g();
  const double nu = rubber.poissons_ratio();
  auto [starts, others] = scaled_starts({curve}, {&model}, options, {nu, 0.3});
  ASSERT_EQ(others.size(), 1u);
  EXPECT_NEAR(others[0](0) / others[0](1), 2.6, 1e-12);
  ASSERT_EQ(starts.size(), 1u) << "0.3 lies on the slope of the valley at nu";
  EXPECT_NEAR(starts[0](0) / rubber.youngs_modulus, 1.0, 1e-9);
  EXPECT_NEAR(starts[0](1) / rubber.shear_modulus, 1.0, 1e-9);
  starts = scaled_starts({curve}, {&model}, options, {0.3}).valleys;
  ASSERT_EQ(starts.size(), 1u);
  EXPECT_NEAR(starts[0](0) / starts[0](1), 2.6, 1e-12);
  // No other scale is better at 0.3.
  const VectorXd y = Eigen::Map<const VectorXd>(curve.y.data(), 3);
  const double best = (model.evaluate(starts[0]).value - y).norm();
  for (const double factor : {0.999, 1.001})
    EXPECT_GT((model.evaluate(factor * starts[0]).value - y).norm(), best);
  options.free[0].upper = 4600.0;
  options.free[1].lower = 1500.0;
  starts = scaled_starts({curve}, {&model}, options, {0.3}).valleys;
  EXPECT_LE(starts[0](0), 4600.0);
  EXPECT_GE(starts[0](1), 1500.0);
  options.free[0].upper = 1e9;
  EXPECT_NE(refusal([&] {
              scaled_starts({curve}, {&model}, e_and_g(), {0.5});
            }).find("between -1 and 1/2"),
            std::string::npos);
}

/// Forces of a rubber a hundred thousand times stiffer than the start: one factor meets them, where
/// all that is stiff is free.
TEST(CurveChecks, AStartTakesTheScaleOfTheData) {
  const std::vector<double> at = {2e-4, 4e-4, 6e-4, 8e-4, 10e-4};
  Curve curve = synthetic(ContactMode::frictionless, at, 0.0, 1, false);
  for (double& force : curve.y) force *= 1e5;
  const PressSetup condition = with_samples(press(ContactMode::frictionless), at);
  const auto start_of = [&](const std::vector<MaterialParameter>& parameters) {
    LatticeForwardModel model(condition, parameters);
    CurveFitOptions options;
    for (const MaterialParameter parameter : parameters)
      options.free.push_back(
          {.parameter = parameter, .start = value_of(parameter, condition), .scale = 1.0});
    return scaled_start({curve}, {&model}, options);
  };
  const auto scale = start_of({modulus});
  ASSERT_TRUE(scale);
  EXPECT_NEAR((*scale)(0) / rubber.youngs_modulus, 1e5, 1e-3);
  const auto springs = start_of({k1, k2, kappa, bond});
  ASSERT_TRUE(springs);
  EXPECT_NEAR((*springs)(0) / condition.lattice.constants.k1, 1e5, 1e-3);
  EXPECT_EQ((*springs)(3), 1.0) << "a factor on the ties is no stiffness";
  EXPECT_FALSE(start_of({youngs_modulus})) << "G is held";
}
