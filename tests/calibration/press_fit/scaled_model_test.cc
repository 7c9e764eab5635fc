/// The model of scaled forces against closed forms (Hertz, a confined layer) and against presses of
/// the real lattice between the nodes.
#include "calibration/press_fit/scaled_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "calibration/press_fit/lattice_forward_model.h"
#include "calibration/statistics/curve_fit.h"
#include "lattice/press/static_press.h"
#include "meshes/base/errors.h"

using namespace fingertip;
using namespace fingertip::calibration;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;
using enum MaterialParameter;

namespace {

const meshes::Rubber rubber;  // E = 40, G = 14 gf/cm², nu = 0.43
const std::vector<double> depths = {2e-4, 5e-4, 9e-4};
constexpr double radius = 0.01;

/// Hertz: F = 4/3 E/(1 - nu²) sqrt(R d³) = G 8/3 sqrt(R d³)/(1 - nu).
double hertz(double e, double g, double depth) {
  const double nu = e / (2.0 * g) - 1.0;
  return 4.0 / 3.0 * e / (1.0 - nu * nu) * std::sqrt(radius * depth * depth * depth);
}

/// F = 2G (1 - nu)/(1 - 2 nu) x, whose pole is at nu = 1/2.
double confined(double e, double g, double x) {
  const double nu = e / (2.0 * g) - 1.0;
  return 2.0 * g * (1.0 - nu) / (1.0 - 2.0 * nu) * x;
}

using Force = std::function<double(double e, double g, double x)>;

/// A solver that answers by a formula and notes what it was asked.
struct Formula {
  Force force;
  std::vector<std::vector<double>>* asked = nullptr;

  std::vector<VectorXd> operator()(const std::vector<double>& ratios) const {
    if (asked) asked->push_back(ratios);
    constexpr double g = 1000.0;
    std::vector<VectorXd> answers;
    for (const double nu : ratios) {
      VectorXd& phi = answers.emplace_back(Index(depths.size()));
      for (std::size_t i = 0; i < depths.size(); ++i)
        phi(Index(i)) = force(2.0 * g * (1.0 + nu), g, depths[i]) / g;
    }
    return answers;
  }
};

ScaledModel model_of(const Force& force,
                     const std::vector<MaterialParameter>& free = {youngs_modulus, shear_modulus},
                     double lowest = -0.9) {
  return {Formula{force}, free, rubber, lowest};
}

/// -1: accepted; otherwise how many violations are told.
int refused(const std::function<void()>& action) {
  try {
    action();
  } catch (const meshes::InvalidInput& error) {
    return int(error.violations().size());
  }
  return -1;
}

}  // namespace

/// (9/16)/24 h^4 of the fourth derivative by xi in the middle of a cell; one-sided at the lowest.
TEST(ScaledModel, MeetsForcesWithinItsBound) {
  for (const Force& force : {Force(hertz), Force(confined)}) {
    ScaledModel model = model_of(force, {youngs_modulus, shear_modulus}, 0.0);
    for (int k = 0; k < 400; ++k) {
      const double nu = 0.4999 * (k + 0.5) / 400.0, g = 1234.5, e = 2.0 * g * (1.0 + nu);
      const VectorXd value = model.evaluate(Vector2d(e, g)).value;
      const double bound = nu < 0.11 ? 2.5e-4 : 1e-4;
      for (std::size_t i = 0; i < depths.size(); ++i)
        EXPECT_NEAR(value(Index(i)) / force(e, g, depths[i]), 1.0, bound) << nu;
    }
  }
}

/// A cubic in ln(1 - 2 nu) comes back exactly, with its slope, below the lowest ratio's node, too.
TEST(ScaledModel, IsExactForCubics) {
  const Force cubic = [](double e, double g, double x) {
    const double xi = std::log(3.0 - e / g);
    return g * x * (2.0 + 0.3 * xi - 0.2 * xi * xi + 0.07 * xi * xi * xi);
  };
  ScaledModel model = model_of(cubic);
  for (const double nu : {-0.89, -0.3, 0.0, 0.2, 0.43, 0.4998}) {
    const double g = 700.0, e = 2.0 * g * (1.0 + nu);
    const CurveSlopes got = model.evaluate(Vector2d(e, g));
    for (std::size_t i = 0; i < depths.size(); ++i)
      EXPECT_NEAR(got.value(Index(i)) / cubic(e, g, depths[i]), 1.0, 1e-11) << nu;
    const double xi = std::log(1.0 - 2.0 * nu), x = depths[1];
    const double by_e = -x / (1.0 - 2.0 * nu) * (0.3 - 0.4 * xi + 0.21 * xi * xi);
    EXPECT_NEAR(got.jacobian(1, 0) / by_e, 1.0, 1e-9) << nu;
  }
}

/// Where Poisson's ratio is held nothing lies between nodes.
TEST(ScaledModel, AsksOnceWhereTheRatioIsHeld) {
  std::vector<std::vector<double>> asked;
  ScaledModel model(Formula{hertz, &asked}, {modulus}, rubber);
  for (const double e : {3000.0, 4000.0, 5000.0}) {
    const CurveSlopes got = model.evaluate(VectorXd::Constant(1, e));
    EXPECT_LT((got.jacobian * e - got.value).norm(), 1e-13 * got.value.norm());
  }
  ASSERT_EQ(asked.size(), 1u);
  EXPECT_EQ(asked[0], std::vector{rubber.poissons_ratio()});
}

/// The solver is asked for four neighbours at once, and never twice.
TEST(ScaledModel, AsksWhereTheSearchIs) {
  std::vector<std::vector<double>> asked;
  ScaledModel model(Formula{hertz, &asked}, {shear_modulus}, rubber);
  for (const double factor : {1.0, 0.9995, 1.0005})
    model.evaluate(VectorXd::Constant(1, factor * rubber.shear_modulus));
  ASSERT_EQ(asked.size(), 1u) << "they share their nodes";
  ASSERT_EQ(asked[0].size(), 4u);
  EXPECT_LT(asked[0][1], rubber.poissons_ratio());
  EXPECT_GT(asked[0][2], rubber.poissons_ratio());
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR((1.0 - 2.0 * asked[0][i + 1]) / (1.0 - 2.0 * asked[0][i]), std::exp(-0.25), 1e-12);
  ScaledModel both(Formula{hertz, &asked}, {youngs_modulus, shear_modulus}, rubber);
  asked.clear();
  both.evaluate(Vector2d(2800.0, 1000.0));
  both.evaluate(Vector2d(2800.0 + 60.0, 1000.0));
  ASSERT_EQ(asked.size(), 2u);
  EXPECT_EQ(asked[1].size(), 1u) << "one cell further";
}

TEST(ScaledModel, JacobianAgreesWithDifferencesAndWithHertz) {
  ScaledModel both = model_of(hertz), turned = model_of(hertz, {shear_modulus, youngs_modulus});
  for (const double nu : {-0.4, 0.05, 0.1, 0.245, 0.4, 0.489}) {
    const Vector2d moduli(2000.0 * (1.0 + nu), 1000.0);
    const MatrixXd jacobian = both.evaluate(moduli).jacobian;
    const MatrixXd swapped = turned.evaluate(moduli.reverse()).jacobian;
    EXPECT_TRUE(swapped.col(0) == jacobian.col(1) && swapped.col(1) == jacobian.col(0));
    for (std::size_t i = 0; i < depths.size(); ++i) {
      // F = G c/(1 - nu), nu = E/(2G) - 1.
      const double c = hertz(2000.0, 1000.0, depths[i]) / 1000.0;
      const double by_e = 0.5 * c / ((1.0 - nu) * (1.0 - nu));
      const double by_g = c / (1.0 - nu) - (1.0 + nu) * c / ((1.0 - nu) * (1.0 - nu));
      EXPECT_NEAR(jacobian(Index(i), 0), by_e, 2e-3 * c) << nu;
      EXPECT_NEAR(jacobian(Index(i), 1), by_g, 4e-3 * c) << nu;
    }
    for (Index j = 0; j < 2; ++j) {
      Vector2d step = Vector2d::Zero();
      step(j) = 1e-5 * moduli(j);
      const VectorXd difference =
          (both.evaluate(moduli + step).value - both.evaluate(moduli - step).value) /
          (2.0 * step(j));
      EXPECT_LT((difference - jacobian.col(j)).norm(), 1e-7 * jacobian.norm()) << nu;
    }
  }
}

TEST(ScaledModel, HoldsTheOtherModulus) {
  ScaledModel both = model_of(hertz);
  ScaledModel of_e = model_of(hertz, {youngs_modulus}), of_g = model_of(hertz, {shear_modulus});
  const double e = 3500.0, g = 1350.0;
  const CurveSlopes with_g = both.evaluate(Vector2d(e, rubber.shear_modulus));
  const CurveSlopes with_e = both.evaluate(Vector2d(rubber.youngs_modulus, g));
  EXPECT_TRUE(of_e.evaluate(VectorXd::Constant(1, e)).value == with_g.value);
  EXPECT_TRUE(of_e.evaluate(VectorXd::Constant(1, e)).jacobian == with_g.jacobian.col(0));
  EXPECT_TRUE(of_g.evaluate(VectorXd::Constant(1, g)).value == with_e.value);
  EXPECT_TRUE(of_g.evaluate(VectorXd::Constant(1, g)).jacobian == with_e.jacobian.col(1));
}

/// G and lambda describe the rubber as E and G do; one of them alone, the other held.
TEST(ScaledModel, KnowsTheConstantsOfTheLaw) {
  ScaledModel by_moduli = model_of(hertz);
  for (const auto& free :
       {std::vector{lame_shear, lambda}, {lambda, lame_shear}, {lambda}, {lame_shear}}) {
    ScaledModel by_law = model_of(hertz, free);
    VectorXd constants(Index(free.size()));
    for (std::size_t i = 0; i < free.size(); ++i)
      constants(Index(i)) = free[i] == lambda ? 9100.0 : 1700.0;
    const auto is_free = [&](MaterialParameter parameter) {
      return std::ranges::find(free, parameter) != free.end();
    };
    const double g = is_free(lame_shear) ? 1700.0 : rubber.shear_modulus;
    const double l = is_free(lambda) ? 9100.0 : rubber.lame_lambda();
    const double e = g * (3.0 * l + 2.0 * g) / (l + g);
    const CurveSlopes got = by_law.evaluate(constants);
    EXPECT_LT((got.value - by_moduli.evaluate(Vector2d(e, g)).value).norm(),
              1e-12 * got.value.norm());
    for (Index j = 0; j < constants.size(); ++j) {
      VectorXd step = VectorXd::Zero(constants.size());
      step(j) = 1e-5 * constants(j);
      const VectorXd difference =
          (by_law.evaluate(constants + step).value - by_law.evaluate(constants - step).value) /
          (2.0 * step(j));
      EXPECT_LT((difference - got.jacobian.col(j)).norm(), 1e-6 * difference.norm()) << j;
    }
  }
}

TEST(ScaledModel, RefusesWhatItDoesNotHold) {
  ScaledModel model = model_of(hertz, {youngs_modulus, shear_modulus}, 0.0);
  const auto at = [&](double nu) {
    return refused([&] { model.evaluate(Vector2d(2e3 * (1.0 + nu), 1e3)); });
  };
  for (const double nu : {0.0, 0.3, 0.4999}) EXPECT_EQ(at(nu), -1) << "round-off refuses no end";
  EXPECT_EQ(at(-0.001), 1);
  EXPECT_EQ(at(0.49995), 1);
  EXPECT_EQ(refused([&] { model.evaluate(Vector2d(-2400.0, -1000.0)); }), 1);
  EXPECT_EQ(refused([&] { model.evaluate(Vector2d(std::nan(""), 1000.0)); }), 1);

  const auto make = [](const std::vector<MaterialParameter>& free,
                       const meshes::Rubber& held = rubber) {
    return refused([&] { ScaledModel(Formula{hertz}, free, held); });
  };
  EXPECT_EQ(make({youngs_modulus}), -1);
  EXPECT_EQ(make({}), 1);
  EXPECT_EQ(make({youngs_modulus, youngs_modulus}), 1);
  EXPECT_EQ(make({youngs_modulus, kappa}), 1);
  EXPECT_EQ(make({youngs_modulus, lambda}), 1);
  EXPECT_EQ(make({modulus, shear_modulus}), 1);
  meshes::Rubber unknown = rubber;
  unknown.shear_modulus = 0.0;
  EXPECT_GE(make({youngs_modulus}, unknown), 1);
}

namespace {

/// Counts the trial points that the model refuses.
class Watched final : public ForwardModel {
 public:
  explicit Watched(ForwardModel& model) : model_(model) {}
  CurveSlopes evaluate(const VectorXd& parameters) override {
    try {
      return model_.evaluate(parameters);
    } catch (const meshes::InvalidInput&) {
      ++refusals;
      throw;
    }
  }
  int refusals = 0;

 private:
  ForwardModel& model_;
};

}  // namespace

/// The stiffness rises toward incompressibility, so that the first step from the flat side is too
/// long: the search shortens it instead of leaving the model's range.
TEST(ScaledModel, IsFittedThoughTheSearchTriesToLeaveIt) {
  const double g = rubber.shear_modulus;
  Curve data{.name = "", .x = depths, .y = {}, .sigma = {}};
  for (const double x : depths) data.y.push_back(confined(2.0 * g * 1.44, g, x));
  ScaledModel model = model_of(confined, {youngs_modulus});
  Watched watched(model);
  CurveFitOptions options;
  options.free = {{.parameter = youngs_modulus, .start = 2.0 * g * 1.0}};
  const CurveFit fit = fit_curves({data}, {&watched}, options);
  EXPECT_GT(watched.refusals, 0);
  EXPECT_NEAR(fit.estimates(0), 2.0 * g * 1.44, 0.1);
}

namespace {

lattice::PressSetup press(double e, double g, meshes::ContactMode contact) {
  lattice::PressSetup setup;
  setup.rubber.youngs_modulus = e;
  setup.rubber.shear_modulus = g;
  setup.lattice.spacing = setup.geometry.tip_radius / 6.0;
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  setup.protocol.contact = contact;
  setup.protocol.samples = {2e-4, 6e-4, 1.2e-3};
  setup.protocol.depth = 1.2e-3;
  setup.threads = 1;
  return setup;
}

VectorXd forces(double e, double g, meshes::ContactMode contact) {
  const auto outcome = lattice::run_static_press(press(e, g, contact));
  VectorXd result(Index(outcome.response.samples().size()));
  for (Index i = 0; i < result.size(); ++i)
    result(i) = outcome.response.samples()[std::size_t(i)].normal_force;
  return result;
}

}  // namespace

TEST(ScaledModel, ForcesOfAPressAreHomogeneousInTheModuli) {
  for (const auto contact : {meshes::ContactMode::frictionless, meshes::ContactMode::stick}) {
    const VectorXd plain = forces(3922.66, 1372.931, contact);
    const VectorXd scaled = forces(7.3 * 3922.66, 7.3 * 1372.931, contact) / 7.3;
    EXPECT_LT(((plain - scaled).array() / plain.array()).abs().maxCoeff(), 1e-9);
  }
}

/// Kinks, where a further point touches, cost most where few points touch; slopes suffer more than
/// forces.
TEST(ScaledModel, AgreesWithPressesOfTheLatticeBetweenItsNodes) {
  const auto contact = meshes::ContactMode::frictionless;
  const auto solve = [&](const std::vector<double>& ratios) {
    std::vector<VectorXd> answers;
    for (const double nu : ratios) answers.push_back(forces(2.0 * (1.0 + nu), 1.0, contact));
    return answers;
  };
  ScaledModel model(solve, {youngs_modulus, shear_modulus}, rubber);
  Eigen::Array3d worst = Eigen::Array3d::Zero(), worst_slope = worst;
  for (const double nu : {0.22, 0.27, 0.31, 0.37, 0.41, 0.43, 0.46, 0.475}) {
    const double g = 1400.0, e = 2.0 * g * (1.0 + nu);
    LatticeForwardModel lattice(press(e, g, contact), {youngs_modulus, shear_modulus});
    const CurveSlopes exact = lattice.evaluate(Vector2d(e, g));
    const CurveSlopes got = model.evaluate(Vector2d(e, g));
    worst = worst.max((got.value.array() / exact.value.array() - 1.0).abs());
    const Eigen::ArrayXXd slope = (got.jacobian.array() / exact.jacobian.array() - 1.0).abs();
    worst_slope = worst_slope.max(slope.rowwise().maxCoeff());
  }
  const Eigen::Array3d allowed(2.5e-3, 1e-4, 1e-4), allowed_slope(1.0, 5e-3, 5e-3);
  for (Index i = 0; i < 3; ++i) {
    EXPECT_LT(worst(i), allowed(i)) << i;
    EXPECT_LT(worst_slope(i), allowed_slope(i)) << i;
  }
}
