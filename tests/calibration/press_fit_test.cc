/// Fits to curves: estimates and standard errors against certified values of a nonlinear regression
/// and textbook formulas, recovery of E and G, and what a single curve cannot say.
#include "calibration/press_fit.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "calibration/fit_statistics.h"
#include "calibration/forward_model.h"
#include "meshes/errors.h"

using namespace fingertip;
using namespace fingertip::calibration;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using enum MaterialParameter;
using lattice::ModelKind;
using lattice::PressSetup;
using meshes::ContactMode;

namespace {

/// Parameters' names mean nothing to it.
class FormulaModel final : public ForwardModel {
 public:
  using Formula = std::function<CurveSlopes(const VectorXd&)>;
  explicit FormulaModel(Formula formula) : formula_(std::move(formula)) {}
  CurveSlopes evaluate(const VectorXd& parameters) override { return formula_(parameters); }

 private:
  Formula formula_;
};

/// F = p0 x + p1 x²
FormulaModel parabola(const std::vector<double>& x) {
  return FormulaModel([x](const VectorXd& p) {
    MatrixXd design(Index(x.size()), 2);
    for (Index i = 0; i < design.rows(); ++i)
      design.row(i) << x[std::size_t(i)], x[std::size_t(i)] * x[std::size_t(i)];
    return CurveSlopes{design * p, design};
  });
}

const meshes::Rubber rubber;  // E = 40, G = 14 gf/cm²

PressSetup press(ContactMode contact, ModelKind model = ModelKind::hookean) {
  PressSetup setup;
  setup.lattice.model = model;
  setup.lattice.spacing = setup.geometry.tip_radius / 6.0;
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  setup.protocol.contact = contact;
  return setup;
}

PressSetup with_samples(PressSetup setup, const std::vector<double>& samples) {
  setup.protocol.samples = samples;
  setup.protocol.depth = samples.back();
  return setup;
}

const std::vector<double> depths = {2e-4, 4e-4, 6e-4, 8e-4, 10e-4, 12e-4};  // [m]
const std::vector<double> shallow = {2e-4, 4e-4, 6e-4, 8e-4, 10e-4};        // [m]

/// Forces of the default rubber, with a normal error of `noise` times each, known if `with_sigma`.
Curve synthetic(ContactMode contact, const std::vector<double>& at, double noise, unsigned seed,
                bool with_sigma) {
  Curve curve;
  curve.indentation = at;
  curve.condition = press(contact);
  LatticeForwardModel model(with_samples(curve.condition, at), {youngs_modulus, shear_modulus});
  const VectorXd force =
      model.evaluate(Eigen::Vector2d(rubber.youngs_modulus, rubber.shear_modulus)).force;
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  for (const double exact : force) {
    curve.force.push_back(exact * (1.0 + noise * normal(generator)));
    if (with_sigma) curve.sigma.push_back(exact * noise);
  }
  return curve;
}

/// Starts 15 and 12 % off, on the incompressible side: Poisson's ratio 0.46 instead of 0.43.
PressFitOptions e_and_g() {
  PressFitOptions options;
  options.free = {{.parameter = youngs_modulus, .start = 4500.0},
                  {.parameter = shear_modulus, .start = 1540.0}};
  return options;
}

std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const meshes::InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

/// NIST StRD, nonlinear regression, Misra1a: y = b1 (1 - exp(-b2 x)), certified to 11 digits.
TEST(PressFit, MeetsCertifiedEstimatesAndStandardErrors) {
  Curve data;
  data.indentation = {77.6,  114.9, 141.1, 190.8, 239.9, 289.0, 332.8,
                      378.4, 434.8, 477.3, 536.8, 593.1, 689.1, 760.0};
  data.force = {10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02,
                44.82, 50.76, 55.05, 61.01, 66.40, 75.47, 81.78};
  FormulaModel model([&](const VectorXd& b) {
    CurveSlopes result{VectorXd(14), MatrixXd(14, 2)};
    for (Index i = 0; i < 14; ++i) {
      const double x = data.indentation[std::size_t(i)], decay = std::exp(-b(1) * x);
      result.force(i) = b(0) * (1.0 - decay);
      result.jacobian.row(i) << 1.0 - decay, b(0) * x * decay;
    }
    return result;
  });
  PressFitOptions options;
  options.free = {{.parameter = kappa, .start = 500.0}, {.parameter = lambda, .start = 1e-4}};
  const PressFit fit = fit_models({data}, {&model}, options);
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
TEST(PressFit, WeighsSigmaAndPriorsLikeTheNormalEquations) {
  Curve data;
  data.indentation = {1.0, 2.0, 3.0, 4.0};
  data.force = {1.4, 3.7, 8.0, 12.1};
  data.sigma = {0.1, 0.2, 0.4, 0.3};
  FormulaModel model = parabola(data.indentation);
  PressFitOptions options;
  options.free = {{.parameter = kappa, .start = 2.0, .prior = Prior{.mean = 1.0, .deviation = 0.2}},
                  {.parameter = lambda, .start = 1.0}};
  const PressFit fit = fit_models({data}, {&model}, options);

  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < 4; ++i) {
    const double x = data.indentation[i];
    const Eigen::Vector2d row = Eigen::Vector2d(x, x * x) / data.sigma[i];
    normal += row * row.transpose();
    right += row * data.force[i] / data.sigma[i];
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
    const double x = data.indentation[i];
    chi_square +=
        std::pow((expected(0) * x + expected(1) * x * x - data.force[i]) / data.sigma[i], 2);
  }
  EXPECT_NEAR(fit.chi_square.value(), chi_square, 1e-9);
}

/// Two degrees of freedom: P = exp(-chi²/2). One: t is Cauchy, tan(0.475 pi).
TEST(PressFit, QuantilesMeetClosedForms) {
  EXPECT_NEAR(chi_square_above(3.0, 2), std::exp(-1.5), 1e-12);
  EXPECT_NEAR(student_95(1), std::tan(0.475 * std::numbers::pi), 1e-9);
  EXPECT_NEAR(student_95(1000000), normal_95(), 1e-5);
}

TEST(PressFit, RobustLossForgivesAnOutlier) {
  Curve data;
  for (int i = 1; i <= 12; ++i) {
    data.indentation.push_back(0.25 * i);
    data.force.push_back(0.5 * i + 0.03 * std::cos(7.0 * i));  // slopes 2 and 0
    data.sigma.push_back(0.03);
  }
  data.force[6] += 1.0;
  FormulaModel model = parabola(data.indentation);
  PressFitOptions options;
  options.free = {{.parameter = kappa, .start = 1.0},
                  {.parameter = lambda, .start = 0.0, .scale = 1.0}};
  const PressFit plain = fit_models({data}, {&model}, options);
  options.robust_width = 1.0;
  const PressFit robust = fit_models({data}, {&model}, options);
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

TEST(PressFit, HoldsBoundsAndSaysSo) {
  Curve data;
  data.indentation = {1.0, 2.0, 3.0};
  data.force = {1.0, 2.1, 2.9};
  FormulaModel model = parabola(data.indentation);
  PressFitOptions options;
  options.free = {{.parameter = k1, .start = 0.5, .upper = 0.6}, {.parameter = k2, .start = 1.0}};
  const PressFit fit = fit_models({data}, {&model}, options);
  EXPECT_NEAR(fit.estimates(0), 0.6, 1e-9);
  EXPECT_TRUE(fit.at_bound[0]);
  EXPECT_FALSE(fit.at_bound[1]);
}

/// lambda = G (E - 2G)/(3G - E)
TEST(PressFit, SlopesOfLambdaMeetDifferences) {
  const auto lambda_of = [](double e, double g) { return g * (e - 2.0 * g) / (3.0 * g - e); };
  const double e = 4.0, g = 1.5, h = 1e-5;
  const Eigen::RowVector2d slopes = lambda_slopes(e, g);
  EXPECT_NEAR(slopes(0), (lambda_of(e + h, g) - lambda_of(e - h, g)) / (2.0 * h), 1e-8);
  EXPECT_NEAR(slopes(1), (lambda_of(e, g + h) - lambda_of(e, g - h)) / (2.0 * h), 1e-7);
}

/// Central differences of whole presses; contacts do not change at these depths.
TEST(PressFit, SlopesOfTheLatticeMeetDifferences) {
  const std::vector<std::pair<PressSetup, std::vector<MaterialParameter>>> cases = {
      {press(ContactMode::frictionless), {youngs_modulus, shear_modulus, bond}},
      {press(ContactMode::stick), {shear_modulus, youngs_modulus}},
      {press(ContactMode::frictionless, ModelKind::network), {youngs_modulus, shear_modulus}},
      {press(ContactMode::frictionless, ModelKind::network), {lambda, lame_shear, contact}},
      {press(ContactMode::frictionless, ModelKind::central), {k2, k1}}};
  for (const auto& [setup, parameters] : cases) {
    LatticeForwardModel model(with_samples(setup, {2.5e-4, 5e-4}), parameters);
    VectorXd p(Index(parameters.size()));
    for (Index j = 0; j < p.size(); ++j) {
      const MaterialParameter parameter = parameters[std::size_t(j)];
      const double a = setup.lattice.spacing, g = rubber.shear_modulus;
      p(j) = parameter == youngs_modulus                             ? rubber.youngs_modulus
             : parameter == shear_modulus || parameter == lame_shear ? g
             : parameter == lambda                                   ? rubber.lame_lambda()
             : parameter == k1 || parameter == k2                    ? a * g
                                                                     : 1.0;
    }
    const CurveSlopes at = model.evaluate(p);
    for (Index j = 0; j < p.size(); ++j) {
      VectorXd up = p, down = p;
      up(j) *= 1.0 + 1e-4;
      down(j) *= 1.0 - 1e-4;
      const VectorXd difference =
          (model.evaluate(up).force - model.evaluate(down).force) / (2e-4 * p(j));
      EXPECT_LT((at.jacobian.col(j) - difference).norm() * p(j), 2e-6 * at.force.norm())
          << lattice::name(setup.lattice.model) << " by " << name(parameters[std::size_t(j)]);
    }
  }
}

TEST(PressFit, RecoversEAndGExactly) {
  const PressFit fit = fit_press({synthetic(ContactMode::frictionless, depths, 0.0, 0, false),
                                  synthetic(ContactMode::stick, depths, 0.0, 0, false)},
                                 e_and_g());
  EXPECT_NEAR(fit.estimates(0) / rubber.youngs_modulus, 1.0, 1e-7);
  EXPECT_NEAR(fit.estimates(1) / rubber.shear_modulus, 1.0, 1e-7);
  EXPECT_TRUE(fit.unidentifiable.empty());
  EXPECT_EQ(fit.degrees_of_freedom, 10);
}

/// A second rubber, of nu near 0.1, meets both curves within 1 %; between it and the true one, at
/// nu near 0.25, the misfit has a ridge.
TEST(PressFit, OfSeveralMinimaTheLeastIsReported) {
  PressFitOptions options = e_and_g();
  options.free[0].start = 4600.0;
  options.free[1].start = 2100.0;
  options.other_starts = {Eigen::Vector2d(4500.0, 1540.0)};
  const PressFit fit =
      fit_press({synthetic(ContactMode::frictionless, {4e-4, 8e-4, 12e-4}, 0.0, 0, false),
                 synthetic(ContactMode::stick, {4e-4, 8e-4, 12e-4}, 0.0, 0, false)},
                options);
  EXPECT_NEAR(fit.estimates(0) / rubber.youngs_modulus, 1.0, 1e-7);
  ASSERT_EQ(fit.minima.size(), 2u);
  EXPECT_GT(fit.minima[0].loss, 1e6 * fit.minima[1].loss);
}

/// Each bound fails by chance in one of 10^4 runs; the seeds are fixed.
TEST(PressFit, NoiseStaysWithinItsStandardErrors) {
  const PressFit fit = fit_press({synthetic(ContactMode::frictionless, depths, 0.01, 1, true),
                                  synthetic(ContactMode::stick, depths, 0.01, 2, true)},
                                 e_and_g());
  EXPECT_LT(std::abs(fit.estimates(0) - rubber.youngs_modulus), 4.0 * fit.standard_errors(0));
  EXPECT_LT(std::abs(fit.estimates(1) - rubber.shear_modulus), 4.0 * fit.standard_errors(1));
  EXPECT_LT(fit.standard_errors(0), 0.03 * rubber.youngs_modulus);
  EXPECT_TRUE(fit.unidentifiable.empty());
  EXPECT_GT(fit.chi_square_probability.value(), 1e-4);
  EXPECT_LT(fit.chi_square_probability.value(), 1.0 - 1e-4);
}

/// A sphere on a half-space knows E/(1 - nu²) = 4 G²/(4 G - E) alone, whose relative slopes are
/// E/(4G - E) > 0 by E and 1 minus that, < 0, by G: E and G that rise together cancel.
TEST(PressFit, OneShallowCurveCannotSeparateEFromG) {
  const Curve curve = synthetic(ContactMode::frictionless, shallow, 0.01, 3, true);
  PressFitOptions options = e_and_g();
  const PressFit open = fit_press({curve}, options);
  ASSERT_EQ(open.unidentifiable.size(), 1u) << open.singular_values.transpose();
  const Direction& weak = open.unidentifiable[0];
  EXPECT_LT(weak.relative_singular_value, 0.02);
  EXPECT_GT(weak.changes(0) * weak.changes(1), 0.0);
  EXPECT_NE(weak.statement.find("youngs_modulus"), std::string::npos) << weak.statement;
  EXPECT_GT(open.correlation(0, 1), 0.98);

  options.free[0].prior = Prior{rubber.youngs_modulus, 0.02 * rubber.youngs_modulus};
  const PressFit closed = fit_press({curve}, options);
  EXPECT_TRUE(closed.unidentifiable.empty());
  ASSERT_EQ(closed.only_from_priors.size(), 1u);
  EXPECT_LT(closed.standard_errors(1), 0.06 * rubber.shear_modulus);
  EXPECT_LT(std::abs(closed.estimates(1) - rubber.shear_modulus), 4.0 * closed.standard_errors(1));
}

TEST(PressFit, BadInputIsRefusedWithItsRule) {
  Curve good;
  good.indentation = {1e-4, 2e-4, 3e-4};
  good.force = {1.0, 2.0, 3.0};
  good.condition = press(ContactMode::frictionless);
  const auto said = [&](const Curve& curve, PressFitOptions options = e_and_g()) {
    return refusal([&] { fit_press({curve}, options); });
  };
  const auto expect = [](const std::string& text, const char* rule) {
    EXPECT_NE(text.find(rule), std::string::npos) << text;
  };
  Curve bad = good;
  bad.indentation.clear();
  bad.force.clear();
  expect(said(bad), "a curve needs points");
  bad = good;
  bad.indentation[2] = 2e-4;
  expect(said(bad), "increasing");
  bad = good;
  bad.indentation[1] = std::nan("");
  expect(said(bad), "finite, positive and increasing");
  bad = good;
  bad.force[1] = std::nan("");
  expect(said(bad), "forces must be finite");
  bad = good;
  bad.force.pop_back();
  expect(said(bad), "as many forces as indentations");
  bad = good;
  bad.sigma = {0.1, -0.1, 0.1};
  expect(said(bad), "standard deviations must be finite and positive");
  bad = good;
  bad.sigma = {0.1, 0.1};
  expect(said(bad), "one standard deviation per force");
  bad = good;
  bad.indentation.resize(2);
  bad.force.resize(2);
  expect(said(bad), "as many as free parameters");
  bad = good;
  bad.condition.lattice.model = ModelKind::central;
  expect(said(bad), "central model does not depend on it");
  bad = good;
  bad.indentation[2] = 1.0;
  expect(said(bad), "depth");

  PressFitOptions options = e_and_g();
  options.free[0].prior = Prior{4000.0, 100.0};
  expect(said(good, options), "known standard deviation");
  options = e_and_g();
  options.free[0].start = -1.0;
  options.free[0].lower = 0.0;
  expect(said(good, options), "within its bounds");
  options = e_and_g();
  options.free[0].parameter = k1;
  expect(said(good, options), "described in one way");
  options = e_and_g();
  options.free[1].parameter = youngs_modulus;
  expect(said(good, options), "named once");
  expect(refusal([&] { fit_press({}, e_and_g()); }), "at least one curve");
  options = e_and_g();
  options.other_starts = {Eigen::VectorXd::Constant(1, 4000.0)};
  expect(said(good, options), "for every free parameter");
  bad = good;
  bad.condition.lattice.spacing *= 0.9;
  options.free = {{.parameter = k1, .start = 2.0}};
  options.other_starts.clear();
  expect(refusal([&] { fit_press({good, bad}, options); }), "one model and spacing");
  // Each is well formed, but E >= 3G is no rubber.
  options = e_and_g();
  options.free[0].start = 3.0 * options.free[1].start;
  expect(said(good, options), "G must exceed E/3");
}
