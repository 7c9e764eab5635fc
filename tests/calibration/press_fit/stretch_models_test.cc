/// Stretch and shear of law A: numbers of another program, limits, the network lattice itself, and
/// what fits to such tests recover and leave open.
#include "calibration/press_fit/stretch_models.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <random>

#include "calibration/statistics/curve_fit.h"
#include "lattice/statics/cut_lattice.h"
#include "lattice/statics/elastic_system.h"
#include "meshes/base/errors.h"
#include "tests/calibration/fit_fixtures.h"

using namespace fingertip;
using namespace fingertip::calibration;
using Eigen::Index;
using Eigen::Vector2d;
using Eigen::VectorXd;
using enum MaterialParameter;

namespace {

constexpr double gf_per_cm2 = 98.0665;  // [Pa]
const meshes::Rubber rubber;            // E = 40, G = 14 gf/cm²
const Vector2d moduli(rubber.youngs_modulus, rubber.shear_modulus);
const std::vector<double> stretches = {0.5, 0.7, 0.8, 0.9, 0.97, 1.05, 1.1, 1.2, 1.5, 2.0, 3.0};

double stress(double stretch, double shear, double lambda_value) {
  return UniaxialModel({stretch}, {lame_shear, lambda})
      .evaluate(Vector2d(shear, lambda_value))
      .value(0);
}

void expect_slopes_of_differences(ForwardModel& model, const VectorXd& at) {
  const CurveSlopes result = model.evaluate(at);
  for (Index j = 0; j < at.size(); ++j) {
    const double step = 1e-5 * at(j);
    const VectorXd shift = step * VectorXd::Unit(at.size(), j);
    const VectorXd slope =
        (model.evaluate(at + shift).value - model.evaluate(at - shift).value) / (2.0 * step);
    const double scale = result.jacobian.col(j).cwiseAbs().maxCoeff();
    EXPECT_LE((result.jacobian.col(j) - slope).cwiseAbs().maxCoeff(), 1e-6 * scale) << j;
  }
}

/// Nominal stress of a free block of 2³ cells of the finite network between smooth clamps, by
/// Newton's method on the lattice's own forces.
double network_stress(double stretch, const meshes::Rubber& material) {
  lattice::LatticeSettings settings;
  settings.model = lattice::ModelKind::network;
  settings.kinematics = lattice::Kinematics::finite;
  settings.spacing = 1e-3;
  settings.constants = lattice::hookean_constants(material, settings.spacing);
  const lattice::LatticeBody body = lattice::build_free_block(material, settings, {2, 2, 2});
  const double width = 2.0 * settings.spacing;
  const lattice::ElasticSystem system(body);
  VectorXd u = VectorXd::Zero(body.unknowns()), force;
  VectorXd held = VectorXd::Zero(u.size());  // 1 where the clamps or the mirror planes hold
  for (std::size_t p = 0; p < body.rest.size(); ++p)
    for (int c = 0; c < 3; ++c) {
      const double at = body.rest[p][c];
      const bool clamped = c == 2 && at > width - 1e-9;
      if (at < 1e-9 || clamped) held(3 * Index(p) + c) = 1.0;
      // The sides start where an incompressible bar would have them.
      u(3 * Index(p) + c) = (c == 2 ? stretch - 1.0 : std::pow(stretch, -0.5) - 1.0) * at;
    }
  lattice::Tangent tangent = system.empty_tangent();
  for (int i = 0; i < 12; ++i) {
    system.assemble(u, force, &tangent);
    Eigen::MatrixXd K = Eigen::MatrixXd(tangent).selfadjointView<Eigen::Lower>();
    VectorXd step = force;
    for (Index j = 0; j < u.size(); ++j) {
      if (held(j) == 0.0) continue;
      K.row(j).setZero();
      K.col(j).setZero();
      K(j, j) = 1.0;
      step(j) = 0.0;
    }
    u += K.ldlt().solve(step);
  }
  system.assemble(u, force, nullptr);
  double clamp = 0.0, loose = 0.0;
  for (std::size_t p = 0; p < body.rest.size(); ++p)
    for (int c = 0; c < 3; ++c) {
      const Index j = 3 * Index(p) + c;
      if (held(j) == 0.0) loose = std::max(loose, std::abs(force(j)));
      if (c == 2 && body.rest[p].z() > width - 1e-9) clamp -= force(j);
    }
  EXPECT_LT(loose, 1e-10 * std::abs(clamp));
  return clamp / (width * width);
}

/// Values of a model with a normal error of `noise` times the largest.
Curve measured(ForwardModel& model, const VectorXd& truth, const std::vector<double>& x,
               double noise, unsigned seed) {
  const VectorXd exact = model.evaluate(truth).value;
  const double sigma = noise * exact.cwiseAbs().maxCoeff();
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal(0.0, sigma);
  Curve curve{.name = "", .x = x, .y = {}, .sigma = {}};
  for (const double value : exact) {
    curve.y.push_back(value + normal(generator));
    curve.sigma.push_back(sigma);
  }
  return curve;
}

}  // namespace

/// Stresses of law A found by another program (nu = 3/7).
TEST(UniaxialModel, MeetsKnownStresses) {
  const std::vector<double> at = {0.8, 0.9, 1.1, 1.2, 1.5};
  const std::vector<double> known = {-9.931, -4.416, 3.677, 6.838, 14.460};  // [gf/cm²]
  const VectorXd found = UniaxialModel(at, {youngs_modulus, shear_modulus}).evaluate(moduli).value;
  for (std::size_t i = 0; i < at.size(); ++i)
    EXPECT_NEAR(found(Index(i)) / gf_per_cm2, known[i], 5.1e-4) << at[i];
}

/// dW/ds with the sides where the energy is least, found by search.
TEST(UniaxialModel, IsTheSlopeOfTheLeastEnergy) {
  const double g = 14.0;
  for (const double l : {0.0, 3.0, 84.0, 7e3}) {
    const auto min_energy = [&](double s) {
      const auto energy = [&](double t) {
        const double log_j = std::log(s * t * t);
        return 0.5 * g * (s * s + 2.0 * t * t - 3.0 - 2.0 * log_j) + 0.5 * l * log_j * log_j;
      };
      double low = 0.2, high = 3.0;  // golden section
      constexpr double golden = 0.6180339887498949;
      for (int i = 0; i < 80; ++i) {
        const double a = high - golden * (high - low), b = low + golden * (high - low);
        (energy(a) < energy(b) ? high : low) = energy(a) < energy(b) ? b : a;
      }
      return energy(0.5 * (low + high));
    };
    for (const double s : stretches) {
      const double h = 1e-4;
      const double slope = (min_energy(s + h) - min_energy(s - h)) / (2.0 * h);
      EXPECT_NEAR(stress(s, g, l), slope, 1e-5 * g) << l << " " << s;
    }
  }
}

TEST(UniaxialModel, SmallStrainGivesYoungsModulus) {
  for (const double nu : {0.0, 0.25, 3.0 / 7.0, 0.4999}) {
    const double g = rubber.shear_modulus, e = 2.0 * g * (1.0 + nu);
    const UniaxialModel tiny({1.0 - 1e-9, 1.0 + 1e-9}, {youngs_modulus, shear_modulus});
    const VectorXd found = UniaxialModel(tiny).evaluate(Vector2d(e, g)).value;
    EXPECT_NEAR(found(0) / (-1e-9 * e), 1.0, 1e-6) << nu;
    EXPECT_NEAR(found(1) / (1e-9 * e), 1.0, 1e-6) << nu;
  }
  EXPECT_EQ(stress(1.0, 14.0, 84.0), 0.0);
}

TEST(UniaxialModel, IncompressibleLimit) {
  const double g = 14.0;
  for (const double s : {0.02, 0.5, 0.9, 1.1, 2.0, 8.0, 50.0}) {
    const double limit = g * (s - 1.0 / (s * s));
    EXPECT_NEAR(stress(s, g, 1e10 * g) / limit, 1.0, 1e-7) << s;
    // The difference is of first order in G/lambda.
    const double first = stress(s, g, 1e5 * g) - limit, second = stress(s, g, 1e6 * g) - limit;
    EXPECT_NEAR(first / second, 10.0, s < 0.1 || s > 10.0 ? 0.5 : 0.01) << s;
  }
  EXPECT_NEAR(stress(2.0, g, 0.0), g * 1.5, 1e-13 * g) << "sides at rest where lambda = 0";
  EXPECT_NEAR(stress(0.5, g, 0.0), -g * 1.5, 1e-13 * g);
}

TEST(UniaxialModel, SlopesEqualDifferences) {
  UniaxialModel by_moduli(stretches, {shear_modulus, youngs_modulus});
  expect_slopes_of_differences(by_moduli, Vector2d(moduli(1), moduli(0)));
  for (const double l : {0.3, 84.0, 1e5}) {
    UniaxialModel by_law(stretches, {lame_shear, lambda});
    expect_slopes_of_differences(by_law, Vector2d(14.0, l));
  }
  UniaxialModel uniaxial(stretches, {youngs_modulus}, rubber);
  expect_slopes_of_differences(uniaxial, VectorXd::Constant(1, rubber.youngs_modulus));
  EXPECT_EQ(uniaxial.evaluate(moduli.head<1>()).value,
            UniaxialModel(stretches, {youngs_modulus, shear_modulus}).evaluate(moduli).value);
  SimpleShearModel shear({0.1, 0.7, 2.0}, {lame_shear, lambda});
  expect_slopes_of_differences(shear, Vector2d(14.0, 84.0));
}

TEST(StretchModels, TheNetworkLatticeBearsTheSameStress) {
  for (const double nu : {0.0, 3.0 / 7.0, 0.499}) {
    meshes::Rubber material;
    material.youngs_modulus = 2.0 * material.shear_modulus * (1.0 + nu);
    const Vector2d p(material.youngs_modulus, material.shear_modulus);
    for (const double s : {0.6, 0.9, 1.3, 2.0}) {
      const double formula =
          UniaxialModel({s}, {youngs_modulus, shear_modulus}).evaluate(p).value(0);
      EXPECT_NEAR(network_stress(s, material) / formula, 1.0, 1e-9) << nu << " " << s;
    }
  }
}

/// dW/dgamma of law A at F = 1 + gamma e1 (x) e2, whose J = 1 and I1 = 3 + gamma².
TEST(SimpleShearModel, IsLinearAndBlindToLambda) {
  SimpleShearModel model({0.1, 0.5, 3.0}, {youngs_modulus, shear_modulus});
  const CurveSlopes found = model.evaluate(moduli);
  EXPECT_NEAR(found.value(2) / gf_per_cm2, 42.0, 1e-12);
  EXPECT_EQ(found.jacobian.col(0).norm(), 0.0);
  EXPECT_EQ(found.jacobian.col(1), Eigen::Vector3d(0.1, 0.5, 3.0));
}

TEST(StretchFit, UniaxialAndShearTestsRecoverTheRubber) {
  const std::vector<double> shears = {0.1, 0.2, 0.4, 0.6, 0.8, 1.0};
  UniaxialModel uniaxial(stretches, {youngs_modulus, shear_modulus});
  SimpleShearModel shear(shears, {youngs_modulus, shear_modulus});
  const std::vector<Curve> curves = {measured(uniaxial, moduli, stretches, 0.005, 4),
                                     measured(shear, moduli, shears, 0.005, 5)};
  CurveFitOptions options;
  options.free = {{.parameter = youngs_modulus, .start = 2500.0},
                  {.parameter = shear_modulus, .start = 1100.0}};
  const CurveFit fit = fit_curves(curves, {&uniaxial, &shear}, options);
  for (Index i = 0; i < 2; ++i) {
    EXPECT_LT(std::abs(fit.estimates(i) - moduli(i)), 3.0 * fit.standard_errors(i)) << i;
    EXPECT_LT(fit.standard_errors(i) / moduli(i), 0.02) << i;
  }
  EXPECT_TRUE(fit.unidentifiable.empty());
  EXPECT_GT(*fit.chi_square_probability, 1e-3);
}

TEST(StretchFit, OneTestOfANearlyIncompressibleRubberLeavesLambdaOpen) {
  const Vector2d truth(1400.0, 1400.0 * 2e3);  // nu = 0.49975
  UniaxialModel model(stretches, {lame_shear, lambda});
  CurveFitOptions options;
  // The scale is G's size, so that lambda's interval is compared with lambda itself.
  options.free = {{.parameter = lame_shear, .start = 1000.0},
                  {.parameter = lambda, .start = 1e5, .lower = 0.0, .upper = 1e8, .scale = 1000.0}};
  for (const unsigned seed : {1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U}) {
    SCOPED_TRACE(seed);
    const CurveFit fit =
        fit_curves({measured(model, truth, stretches, 0.01, seed)}, {&model}, options);
    EXPECT_NEAR(fit.estimates(0) / truth(0), 1.0, 0.05);
    ASSERT_EQ(fit.unidentifiable.size(), 1U);
    const Direction& open = fit.unidentifiable[0];
    EXPECT_NEAR(std::abs(open.changes(1)), 1.0, 1e-12);
    EXPECT_LT(std::abs(open.changes(0)), 0.05);
    EXPECT_NE(open.statement.find("lambda"), std::string::npos) << open.statement;
  }
}

TEST(StretchModels, RefuseWhatIsNoTestOfThisLaw) {
  const auto says = [](const std::function<void()>& action, const std::string& words) {
    const std::string text = refusal(action);
    EXPECT_NE(text.find(words), std::string::npos) << text;
  };
  says([] { UniaxialModel({1.1, 0.0}, {youngs_modulus}); }, "between 0.01 and 100");
  says([] { UniaxialModel({std::nan("")}, {youngs_modulus}); }, "between 0.01 and 100");
  says([] { SimpleShearModel({INFINITY}, {shear_modulus}); }, "finite");
  says([] { UniaxialModel({1.1}, {}); }, "free parameter");
  says([] { UniaxialModel({1.1}, {youngs_modulus, youngs_modulus}); }, "named once");
  says([] { UniaxialModel({1.1}, {youngs_modulus, lambda}); }, "one way");
  says([] { SimpleShearModel({0.1}, {kappa}); }, "do not depend on it");
  UniaxialModel by_moduli({1.1}, {youngs_modulus, shear_modulus});
  says([&] { by_moduli.evaluate(Vector2d(3.0, 1.0)); }, "G must exceed E/3");
  says([&] { by_moduli.evaluate(Vector2d(1.9, 1.0)); }, "nu >= 0");
  UniaxialModel by_law({1.1}, {lame_shear, lambda});
  says([&] { by_law.evaluate(Vector2d(-1.0, 1.0)); }, "G must be finite and positive");
  says([&] { by_law.evaluate(Vector2d(1.0, -0.1)); }, "nu >= 0");
}
