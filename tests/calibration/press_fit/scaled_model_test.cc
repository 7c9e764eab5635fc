/// The model of scaled forces against closed forms (Hertz, a confined layer) and against presses of
/// the real lattice between the nodes.
#include "calibration/press_fit/scaled_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "calibration/press_fit/lattice_forward_model.h"
#include "calibration/statistics/curve_checks.h"
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

/// A bulk of modulus 2G (1 - nu)/(1 - 2 nu) in series with a shear spring 30 times as stiff as G: a
/// confined layer that gives way sideways.
double bulged(double e, double g, double x) {
  const double nu = e / (2.0 * g) - 1.0;
  return g * x / (1.0 / 30.0 + (1.0 - 2.0 * nu) / (2.0 * (1.0 - nu)));
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

/// As a search does that ends there.
CurveSlopes refined(ForwardModel& model, const VectorXd& parameters) {
  while (model.refine(parameters)) continue;
  return model.evaluate(parameters);
}

/// ln((1 + eps)/(1 - 2 nu + eps)), which is 4 at the highest ratio.
double place(double nu) {
  const double eps = (std::exp(-4.0) - 2e-4) / (1.0 - std::exp(-4.0));
  return std::log((1.0 + eps) / (1.0 - 2.0 * nu + eps));
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

/// By five to eight presses, wherever a search ends; a layer that is confined altogether, up to
/// 0.48, where it is 13 times as stiff as at nu = 0.
TEST(ScaledModel, MeetsForcesWithinItsToleranceByFewPresses) {
  for (const auto& [force, highest] :
       {std::pair{Force(hertz), 0.4999}, {Force(bulged), 0.4999}, {Force(confined), 0.48}}) {
    double worst = 0.0;
    for (int k = 0; k < 50; ++k) {
      std::vector<std::vector<double>> asked;
      ScaledModel model(Formula{force, &asked}, {youngs_modulus, shear_modulus}, rubber, 0.0);
      const double nu = highest * (k + 0.5) / 50.0, g = 1234.5, e = 2.0 * g * (1.0 + nu);
      const VectorXd value = refined(model, Vector2d(e, g)).value;
      for (std::size_t i = 0; i < depths.size(); ++i)
        worst = std::max(worst, std::abs(value(Index(i)) / force(e, g, depths[i]) - 1.0));
      EXPECT_LE(asked.size(), 5u) << "four presses at once, then one by one";
    }
    EXPECT_LT(worst, 2.5 * ScaledModel::tolerance) << "an estimate";
  }
}

/// A thin film that is confined altogether has its pole at nu = 1/2: closer nodes there, no more
/// than a dozen, within half a per cent.
TEST(ScaledModel, FollowsAConfinedFilm) {
  std::vector<std::vector<double>> asked;
  ScaledModel model(Formula{confined, &asked}, {youngs_modulus, shear_modulus}, rubber, 0.0);
  const double nu = 0.497, g = 1e3, e = 2.0 * g * (1.0 + nu);
  EXPECT_NEAR(refined(model, Vector2d(e, g)).value(0) / confined(e, g, depths[0]), 1.0, 5e-3);
  EXPECT_LE(asked.size(), 9u);
}

/// ln phi that is a cubic in u comes back exactly, with its slope, below the lowest node, too.
TEST(ScaledModel, IsExactForCubics) {
  const Force cubic = [](double e, double g, double x) {
    const double u = place(e / (2.0 * g) - 1.0);
    return g * x * std::exp(0.3 * u - 0.2 * u * u + 0.07 * u * u * u);
  };
  ScaledModel model = model_of(cubic);
  for (const double nu : {-0.89, -0.3, 0.0, 0.2, 0.43, 0.4998}) {
    const double g = 700.0, e = 2.0 * g * (1.0 + nu);
    const CurveSlopes got = model.evaluate(Vector2d(e, g));
    for (std::size_t i = 0; i < depths.size(); ++i)
      EXPECT_NEAR(got.value(Index(i)) / cubic(e, g, depths[i]), 1.0, 1e-11) << nu;
    const double u = place(nu), eps = (std::exp(-4.0) - 2e-4) / (1.0 - std::exp(-4.0));
    // dF/dE = phi'/2.
    const double by_e =
        cubic(e, g, depths[1]) / g * (0.3 - 0.4 * u + 0.21 * u * u) / (1.0 - 2.0 * nu + eps);
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

/// Four at once, none of them nearly incompressible; then those next to where a search ends, one by
/// one and none twice.
TEST(ScaledModel, AsksWhereTheSearchEnds) {
  std::vector<std::vector<double>> asked;
  ScaledModel model(Formula{hertz, &asked}, {youngs_modulus, shear_modulus}, rubber);
  for (const double e : {2800.0, 2000.0, 2999.0}) model.evaluate(Vector2d(e, 1000.0));
  ASSERT_EQ(asked.size(), 1u) << "wherever it goes";
  ASSERT_EQ(asked[0].size(), 4u);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(place(asked[0][std::size_t(i)]), i, 1e-12);
  const double nu = 0.47;
  refined(model, Vector2d(2000.0 * (1.0 + nu), 1000.0));
  ASSERT_GT(asked.size(), 1u);
  for (std::size_t i = 1; i < asked.size(); ++i) {
    ASSERT_EQ(asked[i].size(), 1u);
    EXPECT_LE(std::abs(place(asked[i][0]) - place(nu)), 1.0);
    EXPECT_NEAR(std::remainder(place(asked[i][0]), 0.5), 0.0, 1e-12);
  }
  const std::size_t known = asked.size();
  refined(model, Vector2d(2000.0 * (1.0 + nu), 1000.0));
  EXPECT_EQ(asked.size(), known);
}

/// What is planned is asked for one rubber: four nodes about it.
TEST(ScaledModel, AsksFourForOneRubber) {
  std::vector<std::vector<double>> asked;
  ScaledModel model(Formula{bulged, &asked}, {youngs_modulus, shear_modulus}, rubber, 0.0,
                    ScaledModel::Use::near_one_ratio);
  const double nu = 0.47, g = 1000.0, e = 2.0 * g * (1.0 + nu), h = 1e-3;
  const CurveSlopes got = refined(model, Vector2d(e, g));
  ASSERT_EQ(asked.size(), 1u);
  ASSERT_EQ(asked[0].size(), 4u);
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const double x = depths[i], slope = (bulged(e + h, g, x) - bulged(e - h, g, x)) / (2.0 * h);
    EXPECT_NEAR(got.value(Index(i)) / bulged(e, g, x), 1.0, 5e-4);
    EXPECT_NEAR(got.jacobian(Index(i), 0) / slope, 1.0, 1e-2);
  }
}

/// A press that finds no equilibrium of a soft bulk is left out; where none does, it is told.
TEST(ScaledModel, GoesOnWithoutANodeThatHasNoAnswer) {
  const auto above = [](double lowest) {
    return [lowest](const std::vector<double>& ratios) {
      for (const double nu : ratios)
        if (nu < lowest) throw meshes::NotConverged("no equilibrium");
      return Formula{hertz}(ratios);
    };
  };
  const double g = 1000.0, e = 2.0 * g * 1.45;
  ScaledModel model(above(0.1), {youngs_modulus, shear_modulus}, rubber, 0.0);
  const VectorXd value = refined(model, Vector2d(e, g)).value;
  EXPECT_NEAR(value(2) / hertz(e, g, depths[2]), 1.0, ScaledModel::tolerance);
  ScaledModel none(above(0.46), {youngs_modulus, shear_modulus}, rubber, 0.0);
  EXPECT_THROW(none.evaluate(Vector2d(e, g)), meshes::NotConverged);
}

/// E and G from two presses that see Poisson's ratio differently, as a fit finds them: six or seven
/// presses each, nothing that is nearly incompressible, and the truth within what the forces are
/// known to.
TEST(ScaledModel, AFitOfTwoPressesAsksForFew) {
  const double nu = 0.48, g = 20e3, e = 2.0 * g * (1.0 + nu);
  std::vector<std::vector<double>> asked[2];
  std::vector<ScaledModel> models;
  std::vector<Curve> curves;
  for (const Force& force : {Force(hertz), Force(bulged)}) {
    models.emplace_back(Formula{force, &asked[models.size()]},
                        std::vector{youngs_modulus, shear_modulus}, rubber, 0.0);
    Curve& curve = curves.emplace_back();
    for (const double x : depths) curve.x.push_back(x), curve.y.push_back(force(e, g, x));
  }
  CurveFitOptions options;
  options.free = {{.parameter = youngs_modulus, .start = 3000.0},
                  {.parameter = shear_modulus, .start = 1100.0}};
  options.lowest_poissons_ratio = 0.0;
  const std::vector<ForwardModel*> addresses = {&models[0], &models[1]};
  const auto starts = scaled_starts(curves, addresses, options, {0.1, 0.3, 0.42, 0.48});
  options.free[0].start = starts.valleys.front()(0), options.free[1].start = starts.valleys[0](1);
  options.other_starts.assign(starts.valleys.begin() + 1, starts.valleys.end());
  const CurveFit fit = fit_curves(curves, addresses, options);
  EXPECT_NEAR(fit.estimates(0) / e, 1.0, 2e-4);
  EXPECT_NEAR(fit.estimates(1) / g, 1.0, 2e-4);
  for (const auto& own : asked) {
    std::vector<double> ratios;
    for (const auto& each : own) ratios.insert(ratios.end(), each.begin(), each.end());
    EXPECT_LE(ratios.size(), 7u);
    EXPECT_LT(std::ranges::max(ratios), 0.494);
  }
}

TEST(ScaledModel, JacobianAgreesWithDifferencesAndWithHertz) {
  ScaledModel both = model_of(hertz), turned = model_of(hertz, {shear_modulus, youngs_modulus});
  for (const double nu : {-0.4, 0.05, 0.1, 0.245, 0.4, 0.489}) {
    const Vector2d moduli(2000.0 * (1.0 + nu), 1000.0);
    const MatrixXd jacobian = refined(both, moduli).jacobian;
    const MatrixXd swapped = refined(turned, moduli.reverse()).jacobian;
    EXPECT_TRUE(swapped.col(0) == jacobian.col(1) && swapped.col(1) == jacobian.col(0));
    for (std::size_t i = 0; i < depths.size(); ++i) {
      // F = G c/(1 - nu), nu = E/(2G) - 1.
      const double c = hertz(2000.0, 1000.0, depths[i]) / 1000.0;
      const double by_e = 0.5 * c / ((1.0 - nu) * (1.0 - nu));
      const double by_g = c / (1.0 - nu) - (1.0 + nu) * c / ((1.0 - nu) * (1.0 - nu));
      EXPECT_NEAR(jacobian(Index(i), 0), by_e, 4e-3 * c) << nu;
      EXPECT_NEAR(jacobian(Index(i), 1), by_g, 1.2e-2 * c) << nu;
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
  bool refine(const VectorXd& parameters) override { return model_.refine(parameters); }
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

VectorXd forces(const lattice::PressSetup& setup) {
  const auto outcome = lattice::run_static_press(setup);
  VectorXd result(Index(outcome.response.samples().size()));
  for (Index i = 0; i < result.size(); ++i)
    result(i) = outcome.response.samples()[std::size_t(i)].normal_force;
  return result;
}

}  // namespace

/// At large strain and with other ties than usual, too.
TEST(ScaledModel, ForcesOfAPressAreHomogeneousInTheModuli) {
  for (const auto contact : {meshes::ContactMode::frictionless, meshes::ContactMode::stick})
    for (const bool network : {false, true}) {
      const auto at = [&](double factor) {
        lattice::PressSetup setup = press(factor * 3922.66, factor * 1372.931, contact);
        setup.lattice.ligament_stiffness = 0.7, setup.lattice.contact_stiffness = 1.6;
        if (network) {
          setup.lattice.model = lattice::ModelKind::network;
          setup.lattice.kinematics = lattice::Kinematics::finite;
        }
        return forces(setup);
      };
      const VectorXd plain = at(1.0), scaled = at(7.3) / 7.3;
      EXPECT_LT(((plain - scaled).array() / plain.array()).abs().maxCoeff(), 1e-8) << network;
    }
}

/// Kinks, where a further point touches, cost most where few points touch; slopes suffer more than
/// forces.
TEST(ScaledModel, AgreesWithPressesOfTheLatticeBetweenItsNodes) {
  const auto contact = meshes::ContactMode::frictionless;
  const auto solve = [&](const std::vector<double>& ratios) {
    std::vector<VectorXd> answers;
    for (const double nu : ratios) answers.push_back(forces(press(2.0 * (1.0 + nu), 1.0, contact)));
    return answers;
  };
  ScaledModel model(solve, {youngs_modulus, shear_modulus}, rubber);
  Eigen::Array3d worst = Eigen::Array3d::Zero(), worst_slope = worst;
  for (const double nu : {0.22, 0.27, 0.31, 0.37, 0.41, 0.43, 0.46, 0.475}) {
    const double g = 1400.0, e = 2.0 * g * (1.0 + nu);
    LatticeForwardModel lattice(press(e, g, contact), {youngs_modulus, shear_modulus});
    const CurveSlopes exact = lattice.evaluate(Vector2d(e, g));
    const CurveSlopes got = refined(model, Vector2d(e, g));
    worst = worst.max((got.value.array() / exact.value.array() - 1.0).abs());
    const Eigen::ArrayXXd slope = (got.jacobian.array() / exact.jacobian.array() - 1.0).abs();
    worst_slope = worst_slope.max(slope.rowwise().maxCoeff());
  }
  const Eigen::Array3d allowed(8e-3, 1e-4, 1e-4), allowed_slope(1.0, 7e-3, 5e-3);
  for (Index i = 0; i < 3; ++i) {
    EXPECT_LT(worst(i), allowed(i)) << i;
    EXPECT_LT(worst_slope(i), allowed_slope(i)) << i;
  }
}
