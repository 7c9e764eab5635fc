/// Tables in Poisson's ratio against closed forms (Hertz, a confined layer) and against presses of
/// the real lattice between the nodes.
#include "calibration/curves/scaled_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "calibration/curves/curve_fit.h"
#include "lattice/press/static_press.h"
#include "meshes/errors.h"

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

using Force = std::function<double(double e, double g, double x)>;

ScaledTable tabulated(const Force& force, const std::vector<double>& x,
                      const std::vector<double>& nodes,
                      const std::vector<MaterialParameter>& free = {youngs_modulus,
                                                                    shear_modulus}) {
  constexpr double g = 1000.0;
  MatrixXd scaled(Index(x.size()), Index(nodes.size()));
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t k = 0; k < nodes.size(); ++k)
      scaled(Index(i), Index(k)) = force(2.0 * g * (1.0 + nodes[k]), g, x[i]) / g;
  return {nodes, scaled, free, rubber};
}

/// Largest relative error over 50 Poisson's ratios inside.
double worst_error(ScaledTable& table, const Force& force, const std::vector<double>& x) {
  double worst = 0.0;
  for (int k = 0; k < 50; ++k) {
    const double nu = table.lower() + (table.upper() - table.lower()) * (k + 0.5) / 50.0;
    const double g = 1234.5, e = 2.0 * g * (1.0 + nu);
    const VectorXd value = table.evaluate(Vector2d(e, g)).value;
    for (std::size_t i = 0; i < x.size(); ++i)
      worst = std::max(worst, std::abs(value(Index(i)) / force(e, g, x[i]) - 1.0));
  }
  return worst;
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

TEST(ScaledTable, NodesAreChebyshevPoints) {
  const std::vector<double> nodes = chebyshev_nodes(0.1, 0.5, 5);
  const std::vector<double> expected = {0.1, 0.3 - 0.1 * std::sqrt(2.0), 0.3,
                                        0.3 + 0.1 * std::sqrt(2.0), 0.5};
  ASSERT_EQ(nodes.size(), expected.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) EXPECT_NEAR(nodes[i], expected[i], 1e-15);
  // Those of half as many intervals are among them: a table can be refined.
  const std::vector<double> coarse = chebyshev_nodes(0.1, 0.5, 3);
  for (std::size_t i = 0; i < coarse.size(); ++i) EXPECT_NEAR(nodes[2 * i], coarse[i], 1e-15);
  EXPECT_EQ(refused([] { chebyshev_nodes(0.1, 0.1, 5); }), 1);
  EXPECT_EQ(refused([] { chebyshev_nodes(0.1, 0.2, 1); }), 1);
}

/// phi has its pole at nu = 1: in units of half the range 0.1 ... 0.49 from its middle at t = 3.62,
/// so each node divides the error by t + sqrt(t² - 1) = 7.1 (Trefethen, theorem 8.2).
TEST(ScaledTable, ConvergesExponentiallyWherePhiIsAnalytic) {
  double before = 0.0;
  for (int count = 3; count <= 9; count += 2) {
    ScaledTable table = tabulated(hertz, depths, chebyshev_nodes(0.1, 0.49, count));
    const double error = worst_error(table, hertz, depths);
    if (before > 0.0) {
      EXPECT_NEAR(before / error, 7.09 * 7.09, 10.0) << count;
    }
    before = error;
  }
  EXPECT_LT(before, 1e-7);
  ScaledTable exact = tabulated(hertz, depths, chebyshev_nodes(0.1, 0.49, 20));
  EXPECT_LT(worst_error(exact, hertz, depths), 1e-13);
}

/// Also for F = 2G (1 - nu)/(1 - 2 nu) x, with a pole just beyond the end.
TEST(ScaledTable, EstimatesTheErrorOfTheTableWithHalfTheNodes) {
  const Force confined = [](double e, double g, double x) {
    const double nu = e / (2.0 * g) - 1.0;
    return 2.0 * g * (1.0 - nu) / (1.0 - 2.0 * nu) * x;
  };
  for (const Force& force : {Force(hertz), confined}) {
    for (const int half : {3, 5, 7}) {
      ScaledTable fine = tabulated(force, depths, chebyshev_nodes(0.1, 0.45, 2 * half - 1));
      ScaledTable coarse = tabulated(force, depths, chebyshev_nodes(0.1, 0.45, half));
      const double of_coarse = worst_error(coarse, force, depths);
      EXPECT_LE(fine.interpolation_error().maxCoeff(), of_coarse * 1.01) << half;
      EXPECT_GE(fine.interpolation_error().minCoeff(), of_coarse * 0.5) << half;
      EXPECT_LT(worst_error(fine, force, depths), 0.5 * of_coarse) << half;
    }
  }
  ScaledTable without_contact =
      tabulated([](double, double, double) { return 0.0; }, depths, chebyshev_nodes(0.1, 0.45, 5));
  EXPECT_EQ(without_contact.interpolation_error().maxCoeff(), 0.0);
}

/// Any nodes in any order: an exact polynomial comes back, and its error is estimated as nothing.
TEST(ScaledTable, TakesAnyNodesInAnyOrder) {
  const Force parabola = [](double e, double g, double x) {
    const double nu = e / (2.0 * g) - 1.0;
    return g * x * (1.0 + 0.5 * nu - 2.0 * nu * nu);
  };
  ScaledTable table = tabulated(parabola, depths, {0.3, -0.2, 0.45, 0.0, 0.41});
  EXPECT_EQ(table.lower(), -0.2);
  EXPECT_EQ(table.upper(), 0.45);
  EXPECT_LT(worst_error(table, parabola, depths), 1e-13);
  EXPECT_LT(table.interpolation_error().maxCoeff(), 1e-13);
}

TEST(ScaledTable, JacobianAgreesWithDifferencesAndWithHertz) {
  ScaledTable both = tabulated(hertz, depths, chebyshev_nodes(0.0, 0.49, 12));
  ScaledTable turned =
      tabulated(hertz, depths, chebyshev_nodes(0.0, 0.49, 12), {shear_modulus, youngs_modulus});
  for (const double nu : {0.0, 0.1, 0.245, 0.4, 0.489}) {
    const Vector2d moduli(2000.0 * (1.0 + nu), 1000.0);
    const MatrixXd jacobian = both.evaluate(moduli).jacobian;
    const MatrixXd swapped = turned.evaluate(moduli.reverse()).jacobian;
    EXPECT_TRUE(swapped.col(0) == jacobian.col(1) && swapped.col(1) == jacobian.col(0));
    for (std::size_t i = 0; i < depths.size(); ++i) {
      // F = G c/(1 - nu), nu = E/(2G) - 1.
      const double c = hertz(2000.0, 1000.0, depths[i]) / 1000.0;
      const double by_e = 0.5 * c / ((1.0 - nu) * (1.0 - nu));
      const double by_g = c / (1.0 - nu) - (1.0 + nu) * c / ((1.0 - nu) * (1.0 - nu));
      EXPECT_NEAR(jacobian(Index(i), 0), by_e, 1e-6 * c) << nu;
      EXPECT_NEAR(jacobian(Index(i), 1), by_g, 1e-6 * c) << nu;
    }
    if (nu == 0.0) continue;  // its differences would leave the table
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

TEST(ScaledTable, HoldsTheOtherModulus) {
  const auto nodes = chebyshev_nodes(0.1, 0.49, 12);
  ScaledTable both = tabulated(hertz, depths, nodes);
  ScaledTable of_e = tabulated(hertz, depths, nodes, {youngs_modulus});
  ScaledTable of_g = tabulated(hertz, depths, nodes, {shear_modulus});
  const double e = 3500.0, g = 1350.0;
  const CurveSlopes with_g = both.evaluate(Vector2d(e, rubber.shear_modulus));
  const CurveSlopes with_e = both.evaluate(Vector2d(rubber.youngs_modulus, g));
  EXPECT_TRUE(of_e.evaluate(VectorXd::Constant(1, e)).value == with_g.value);
  EXPECT_TRUE(of_e.evaluate(VectorXd::Constant(1, e)).jacobian == with_g.jacobian.col(0));
  EXPECT_TRUE(of_g.evaluate(VectorXd::Constant(1, g)).value == with_e.value);
  EXPECT_TRUE(of_g.evaluate(VectorXd::Constant(1, g)).jacobian == with_e.jacobian.col(1));
}

TEST(ScaledTable, RefusesWhatItDoesNotHold) {
  const std::vector<double> nodes = {0.1, 0.3, 0.45};
  ScaledTable table = tabulated(hertz, depths, nodes);
  const auto at = [&](double nu) {
    return refused([&] { table.evaluate(Vector2d(2e3 * (1.0 + nu), 1e3)); });
  };
  for (const double node : nodes) EXPECT_EQ(at(node), -1) << "round-off refuses no node";
  EXPECT_EQ(at(0.0999), 1);
  EXPECT_EQ(at(0.4501), 1);
  EXPECT_EQ(refused([&] { table.evaluate(Vector2d(-2400.0, -1000.0)); }), 1);
  EXPECT_EQ(refused([&] { table.evaluate(Vector2d(std::nan(""), 1000.0)); }), 1);

  const MatrixXd ones = MatrixXd::Ones(3, 3);
  const auto make = [](const std::vector<double>& nu, const MatrixXd& scaled,
                       const std::vector<MaterialParameter>& free,
                       const meshes::Rubber& held = rubber) {
    return refused([&] { ScaledTable(nu, scaled, free, held); });
  };
  EXPECT_EQ(make(nodes, ones, {youngs_modulus}), -1);
  EXPECT_EQ(make({0.1, 0.3, 0.1}, ones, {youngs_modulus}), 1);
  EXPECT_EQ(make({0.1, 0.3, 0.5}, ones, {youngs_modulus}), 1);
  EXPECT_EQ(make({0.1, 0.3, std::nan("")}, ones, {youngs_modulus}), 1);
  EXPECT_EQ(make({0.1, 0.2}, MatrixXd::Ones(3, 2), {youngs_modulus}), 1);
  EXPECT_EQ(make({0.1, 0.2, 0.3, 0.4}, ones, {youngs_modulus}), 1);
  EXPECT_EQ(make(nodes, MatrixXd(0, 3), {youngs_modulus}), 1);
  EXPECT_EQ(make(nodes, ones * std::nan(""), {youngs_modulus}), 1);
  EXPECT_EQ(make(nodes, ones, {}), 1);
  EXPECT_EQ(make(nodes, ones, {youngs_modulus, youngs_modulus}), 1);
  EXPECT_EQ(make(nodes, ones, {youngs_modulus, kappa}), 1);
  meshes::Rubber unknown = rubber;
  unknown.shear_modulus = 0.0;
  EXPECT_EQ(make(nodes, ones, {youngs_modulus}, unknown), 1);
  EXPECT_EQ(make(nodes, ones, {youngs_modulus, shear_modulus}, unknown), -1);
}

namespace {

/// Counts the trial points that the table refuses.
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

/// phi rises toward the end, so that the first step from the flat side is too long: the search
/// shortens it instead of leaving the table.
TEST(ScaledTable, IsFittedThoughTheSearchTriesToLeaveIt) {
  const Force confined = [](double e, double g, double x) {
    const double nu = e / (2.0 * g) - 1.0;
    return g * (1.0 - nu) / (1.0 - 2.0 * nu) * x;
  };
  const double g = rubber.shear_modulus;
  Curve data{.name = "", .x = depths, .y = {}, .sigma = {}};
  for (const double x : depths) data.y.push_back(confined(2.0 * g * 1.44, g, x));
  ScaledTable table = tabulated(confined, depths, chebyshev_nodes(0.2, 0.45, 14), {youngs_modulus});
  Watched watched(table);
  CurveFitOptions options;
  options.free = {{.parameter = youngs_modulus, .start = 2.0 * g * 1.25}};
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

TEST(ScaledTable, ForcesOfAPressAreHomogeneousInTheModuli) {
  for (const auto contact : {meshes::ContactMode::frictionless, meshes::ContactMode::stick}) {
    const VectorXd one = forces(3922.66, 1372.931, contact);
    const VectorXd scaled = forces(7.3 * 3922.66, 7.3 * 1372.931, contact) / 7.3;
    EXPECT_LT(((one - scaled).array() / one.array()).abs().maxCoeff(), 1e-9);
  }
}

/// Kinks, where a further point touches, keep the table from converging exponentially, most where
/// few points touch; slopes suffer more than forces.
TEST(ScaledTable, AgreesWithPressesOfTheLatticeBetweenItsNodes) {
  const auto contact = meshes::ContactMode::frictionless;
  const auto nodes = chebyshev_nodes(0.2, 0.48, 9);
  MatrixXd scaled(3, 9);
  for (int k = 0; k < 9; ++k)
    scaled.col(k) = forces(2.0 * (1.0 + nodes[std::size_t(k)]), 1.0, contact);
  ScaledTable table(nodes, scaled, {youngs_modulus, shear_modulus}, rubber);
  const VectorXd estimate = table.interpolation_error();
  Eigen::Array3d worst = Eigen::Array3d::Zero(), worst_slope = worst;
  for (const double nu : {0.22, 0.27, 0.31, 0.37, 0.41, 0.43, 0.46, 0.475}) {
    const double g = 1400.0, e = 2.0 * g * (1.0 + nu);
    LatticeForwardModel lattice(press(e, g, contact), {youngs_modulus, shear_modulus});
    const CurveSlopes exact = lattice.evaluate(Vector2d(e, g));
    const CurveSlopes got = table.evaluate(Vector2d(e, g));
    worst = worst.max((got.value.array() / exact.value.array() - 1.0).abs());
    const Eigen::ArrayXXd slope = (got.jacobian.array() / exact.jacobian.array() - 1.0).abs();
    worst_slope = worst_slope.max(slope.rowwise().maxCoeff());
  }
  const Eigen::Array3d allowed(2.5e-3, 1e-4, 1e-5), allowed_slope(1.0, 5e-3, 5e-4);
  for (Index i = 0; i < 3; ++i) {
    EXPECT_LT(worst(i), allowed(i)) << i;
    EXPECT_LT(worst(i), estimate(i)) << i;
    EXPECT_LT(estimate(i), 50.0 * worst(i)) << i;
    EXPECT_LT(worst_slope(i), allowed_slope(i)) << i;
  }
}
