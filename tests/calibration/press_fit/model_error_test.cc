#include "calibration/press_fit/model_error.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "calibration/press_fit/fit_record.h"
#include "calibration/statistics/curve_checks.h"
#include "calibration/statistics/fit_statistics.h"
#include "lattice/press/static_press.h"
#include "tests/calibration/fit_fixtures.h"

using namespace fit_fixtures;

namespace {

constexpr double gram_force = 9.80665e-3;  // [N]

/// Forces of the small-strain continuum over a frictionless plane, by another program: axisymmetric
/// quadratic elements, 0.01 %.
struct Continuum {
  std::vector<double> depth, force;  ///< SI
};

Continuum continuum() {
  Continuum result;
  std::ifstream file(FINGERTIP_CONTINUUM_DATA);
  std::string line;
  while (std::getline(file, line)) {
    if (line.empty() || !std::isdigit(static_cast<unsigned char>(line[0]))) continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream cells(line);
    double depth = 0.0, force = 0.0;
    cells >> depth >> force;
    result.depth.push_back(1e-2 * depth);
    result.force.push_back(gram_force * force);
  }
  return result;
}

PressSetup at_spacing(double cells, const std::vector<double>& depth) {
  PressSetup setup = press(ContactMode::frictionless);
  setup.lattice.spacing = setup.geometry.tip_radius / cells;
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  return with_samples(setup, depth);
}

Curve noisy(const Continuum& truth, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  Curve curve;
  curve.x = truth.depth;
  for (const double force : truth.force) {
    curve.y.push_back(force * (1.0 + 0.01 * normal(generator)));
    curve.sigma.push_back(0.01 * force);
  }
  return curve;
}

}  // namespace

/// The errors of lattices against an independent continuum, in units of the covariance, are as
/// large as chance makes them; against 1 % of noise alone they are impossible.
TEST(ModelError, ExplainsWhatLatticesMiss) {
  const Continuum truth = continuum();
  ASSERT_EQ(truth.depth.size(), 10u);
  const VectorXd force = VectorXd::Map(truth.force.data(), 10);
  for (const double cells : {5.0, 6.0, 8.0}) {
    const PressSetup setup = at_spacing(cells, truth.depth);
    const lattice::StaticOutcome outcome = lattice::run_static_press(setup);
    VectorXd error(10);
    for (Index i = 0; i < 10; ++i)
      error(i) = outcome.response.samples()[std::size_t(i)].normal_force / force(i) - 1.0;
    MatrixXd covariance = lattice_covariance({setup});
    EXPECT_LT((covariance - covariance.transpose()).norm(), 1e-15);
    const double without = error.squaredNorm() / 1e-4;
    EXPECT_LT(chi_square_above(without, 10), 5e-4) << cells;
    covariance.diagonal().array() += 1e-4;
    const double with = error.dot(covariance.ldlt().solve(error));
    EXPECT_GT(chi_square_above(with, 10), 0.05) << cells << ": " << with;
    EXPECT_LT(chi_square_above(with, 10), 0.9999) << cells << ": too cautious, " << with;
  }
}

/// Of a continuum's forces with 1 % of noise a coarse lattice finds the modulus within its
/// interval, and its chi-square does not alarm; noise of 5 % that is told as 1 % it does notice.
TEST(ModelError, CleanDataDoNotAlarmAndBadDataDo) {
  const Continuum truth = continuum();
  for (const double cells : {6.0, 8.0}) {
    const PressSetup setup = at_spacing(cells, truth.depth);
    ScaledModel model = scaled_press(setup, {modulus});
    CurveFitOptions options;
    options.free = {{.parameter = modulus, .start = 3000.0}};
    const VectorXd force = VectorXd::Map(truth.force.data(), 10);
    options.model_covariance =
        force.asDiagonal() * lattice_covariance({setup}) * force.asDiagonal();
    int inside = 0, alarms = 0;
    for (unsigned seed = 1; seed <= 40; ++seed) {
      const CurveFit fit = fit_curves({noisy(truth, seed)}, {&model}, options);
      inside += fit.lower(0) < rubber.youngs_modulus && rubber.youngs_modulus < fit.upper(0);
      alarms += fit.chi_square_probability.value() < 0.01;
    }
    EXPECT_GE(inside, 37) << cells;
    EXPECT_LE(alarms, 1) << cells;
    Curve bad = noisy(truth, 1);
    for (std::size_t i = 0; i < bad.y.size(); ++i) bad.y[i] *= i % 2 == 0 ? 1.05 : 0.95;
    EXPECT_LT(fit_curves({bad}, {&model}, options).chi_square_probability.value(), 0.01) << cells;
  }
}

/// Law A over small strain, frictionless, 0.05 ... 0.3 cm: two continua of fingertip-fem and the
/// axisymmetric one say 1.5, 8.4, 17.7, 28.3, 40.2, 53.4 %.
TEST(ModelError, KnowsWhatFiniteStrainAdds) {
  const std::vector<double> depth = {0.5e-3, 1e-3, 1.5e-3, 2e-3, 2.5e-3, 3e-3};
  const VectorXd excess =
      excess_of_finite_strain(with_samples(press(ContactMode::frictionless), depth));
  const double expected[] = {0.0154, 0.0839, 0.1767, 0.2829, 0.4020, 0.5338};
  for (Index i = 0; i < 6; ++i)
    // At 0.05 cm the contact's radius is a cell and a third.
    EXPECT_NEAR(excess(i), expected[i], (i == 0 ? 0.0125 : 0.01) + 0.04 * expected[i])
        << depth[std::size_t(i)];
}

/// Of a ball on the default finger, frictionless at small strain: continua of fingertip-fem to 0.1
/// % with either value of each number.
TEST(ModelError, KnowsWhatSizesDoToForces) {
  PressSetup ball = with_samples(press(ContactMode::frictionless), {0.5e-3, 1e-3, 1.5e-3});
  ball.protocol.obstacle = {.shape = meshes::ObstacleShape::sphere, .radius = 8e-3};
  struct Number {
    Described what;
    double low, high, expected[3];
  };
  const Number numbers[] = {
      {Described::tip_radius, 9.5e-3, 10.5e-3, {-0.04303, -0.07119, -0.08907}},
      {Described::rod_radius, 4.75e-3, 5.25e-3, {0.04647, 0.06740, 0.08175}},
      {Described::obstacle_radius, 7e-3, 9e-3, {0.08701, 0.09469, 0.09859}},
      {Described::poissons_ratio, 0.41, 0.45, {0.04213, 0.04042, 0.03843}}};
  for (const Number& each : numbers) {
    const VectorXd change = change_between(ball, each.what, each.low, each.high);
    for (Index i = 0; i < 3; ++i)
      EXPECT_NEAR(
          change(i), each.expected[i],
          (each.what == Described::poissons_ratio ? 0.1 : 0.26) * std::abs(each.expected[i]))
          << name(each.what) << " at sample " << i;
  }
}

/// A finger whose radii are larger by the same share; the sleeve hardly matters.
TEST(ModelError, ScaleIsAllSizesTogether) {
  PressSetup ball = with_samples(press(ContactMode::frictionless), {1e-3, 2e-3});
  ball.protocol.obstacle = {.shape = meshes::ObstacleShape::sphere, .radius = 8e-3};
  const VectorXd all = change_between(ball, Described::scale, 0.99, 1.01);
  VectorXd sum = VectorXd::Zero(2), sizes = sum;  // of opposite sign: their sum is small
  for (const Described what : {Described::tip_radius, Described::rod_radius}) {
    const double value = value_of(ball, what);
    const VectorXd own = change_between(ball, what, 0.99 * value, 1.01 * value);
    sum += own, sizes += own.cwiseAbs();
  }
  for (Index i = 0; i < 2; ++i) EXPECT_NEAR(all(i), sum(i), 0.06 * sizes(i)) << i;
}

TEST(ModelError, SizesBelongToWhatHasThem) {
  PressSetup setup = press(ContactMode::frictionless);
  EXPECT_TRUE(has(setup, Described::tip_radius));
  EXPECT_FALSE(has(setup, Described::obstacle_radius));
  setup.protocol.obstacle = {.shape = meshes::ObstacleShape::cylinder, .radius = 8e-3};
  EXPECT_TRUE(has(setup, Described::obstacle_radius));
  setup.geometry = meshes::Geometry::of_profile(setup.geometry.corners());
  EXPECT_FALSE(has(setup, Described::rod_radius));
}

/// A covariance v vᵀ is a share of v that nobody knows: a further parameter with a prior.
TEST(ModelError, IsAParameterNobodyAskedFor) {
  Curve data;
  for (int i = 1; i <= 9; ++i) {
    data.x.push_back(0.3 * i);
    data.y.push_back(0.9 * i + 0.05 * std::cos(5.0 * i));
    data.sigma.push_back(0.02 * (1 + i % 3));
  }
  VectorXd shape(9);
  for (Index i = 0; i < 9; ++i) shape(i) = 0.04 * std::pow(data.x[std::size_t(i)], 3);
  FormulaModel linear_model = parabola(data.x);
  CurveFitOptions options;
  options.free = {{.parameter = kappa, .start = 1.0},
                  {.parameter = lambda, .start = 0.0, .scale = 1.0}};
  options.model_covariance = shape * shape.transpose();
  const CurveFit fit = fit_curves({data}, {&linear_model}, options);

  FormulaModel three([&](const VectorXd& p) {
    MatrixXd design(9, 3);
    for (Index i = 0; i < 9; ++i) {
      const double x = data.x[std::size_t(i)];
      design.row(i) << x, x * x, shape(i);
    }
    return CurveSlopes{design * p, design};
  });
  CurveFitOptions wider;
  wider.free = {{.parameter = kappa, .start = 1.0},
                {.parameter = lambda, .start = 0.0, .scale = 1.0},
                {.parameter = kappa, .start = 1.0, .prior = Prior{0.0, 1.0}}};
  const CurveFit full = fit_curves({data}, {&three}, wider);
  for (Index i = 0; i < 2; ++i) {
    EXPECT_NEAR(fit.estimates(i), full.estimates(i), 1e-8);
    EXPECT_NEAR(fit.standard_errors(i), full.standard_errors(i), 1e-8);
  }
  EXPECT_NEAR(fit.chi_square.value(), full.chi_square.value(), 1e-7);

  // Without sigma the estimates know nothing of it, and it comes through.
  data.sigma.clear();
  const CurveFit through = fit_curves({data}, {&linear_model}, options);
  options.model_covariance.resize(0, 0);
  const CurveFit plain = fit_curves({data}, {&linear_model}, options);
  EXPECT_LT((through.estimates - plain.estimates).norm(), 1e-12);
  const VectorXd shift = plain.influence * shape;
  EXPECT_LT((through.covariance - plain.covariance - shift * shift.transpose()).norm(),
            1e-9 * through.covariance.norm());
}

/// One number: the force over it is its slope, and it is found from any distance.
TEST(ModelError, TheModulusAtHeldRatioIsAScale) {
  const PressSetup setup = with_samples(press(ContactMode::frictionless), shallow);
  LatticeForwardModel model(setup, {modulus});
  const CurveSlopes at = model.evaluate(VectorXd::Constant(1, 1e6));
  EXPECT_LT((1e6 * at.jacobian.col(0) - at.value).norm(), 1e-9 * at.value.norm());
  const VectorXd own = model.evaluate(VectorXd::Constant(1, rubber.youngs_modulus)).value;
  EXPECT_LT((at.value * rubber.youngs_modulus / 1e6 - own).norm(), 1e-9 * own.norm());
}

/// Evaluations that do not suffice end a search with the best it has seen, and say so.
TEST(ModelError, ABudgetEndsASearch) {
  Curve data;
  data.x = {1.0, 2.0, 3.0, 4.0};
  data.y = {2.7, 7.4, 20.1, 54.6};
  data.sigma = {0.1, 0.1, 0.1, 0.1};
  FormulaModel model([&](const VectorXd& p) {
    MatrixXd slopes(4, 2);
    VectorXd value(4);
    for (Index i = 0; i < 4; ++i) {
      const double x = data.x[std::size_t(i)];
      value(i) = p(0) * std::exp(p(1) * x);
      slopes.row(i) << std::exp(p(1) * x), p(0) * x * std::exp(p(1) * x);
    }
    return CurveSlopes{value, slopes};
  });
  CurveFitOptions options;
  options.free = {{.parameter = kappa, .start = 30.0}, {.parameter = lambda, .start = 0.2}};
  options.other_starts = {Eigen::Vector2d(20.0, 0.3)};
  const CurveFit whole = fit_curves({data}, {&model}, options);
  EXPECT_TRUE(whole.converged);
  options.max_evaluations = 4;
  const CurveFit cut = fit_curves({data}, {&model}, options);
  EXPECT_FALSE(cut.converged);
  EXPECT_LE(cut.evaluations, 4);
  ASSERT_EQ(cut.minima.size(), 2u);
  const double best = std::min(cut.minima[0].loss, cut.minima[1].loss);
  EXPECT_NEAR(0.5 * cut.chi_square.value(), best, 1e-9 * best);
  EXPECT_GT(best, 2.0 * whole.chi_square.value());
}

namespace {

FitRecord record_of(const Curve& curve, FormulaModel& model, const CurveFitOptions& options) {
  FitRecord record;
  record.problem = "experiment";
  record.curves = {curve};
  record.conditions = {""};
  record.options = options;
  record.fit = fit_curves({curve}, {&model}, options);
  record.material.spacing = 1e-3;
  record.material.constants = lattice::hookean_constants(record.material.rubber, 1e-3);
  return record;
}

bool says(const FitRecord& record, const char* words) {
  for (const std::string& failure : failed_tests(record))
    if (failure.find(words) != std::string::npos)
      return fit_statement(record).find(failure) != std::string::npos;
  return false;
}

}  // namespace

TEST(FitVerdict, TellsWhyAFitCannotBeUsed) {
  Curve good;
  good.x = {1.0, 2.0, 3.0, 4.0, 5.0};
  good.y = {1.01, 1.98, 3.01, 4.02, 4.99};
  good.sigma.assign(5, 0.02);
  FormulaModel line([&](const VectorXd& p) {
    const VectorXd x = VectorXd::Map(good.x.data(), 5);
    return CurveSlopes{p(0) * x, MatrixXd(x)};
  });
  CurveFitOptions options;
  options.free = {{.parameter = modulus, .start = 2.0}};
  FitRecord record = record_of(good, line, options);
  EXPECT_TRUE(failed_tests(record).empty()) << failed_tests(record).front();

  record.material.rubber.youngs_modulus = 1e52;
  record.material.rubber.shear_modulus = 4e51;
  record.material.constants = lattice::hookean_constants(record.material.rubber, 1e-3);
  EXPECT_TRUE(says(record, "no rubber's"));

  Curve bent = good;
  for (double& y : bent.y) y *= y;
  EXPECT_TRUE(says(record_of(bent, line, options), "chi-square"));
  bent.sigma.clear();
  EXPECT_TRUE(says(record_of(bent, line, options), "is missed by"));
  good.sigma.clear();
  record = record_of(good, line, options);
  EXPECT_TRUE(failed_tests(record).empty());
  // What is missed beyond noise, and a machine that is not what was known of it.
  record.errors = ErrorsEntry{.misfit = 0.09};
  EXPECT_TRUE(failed_tests(record).empty());
  record.errors->misfit = 0.11;
  EXPECT_TRUE(says(record, "it misses 11 % of them beyond noise"));
  record.errors->misfit = 0.0;
  record.fit.parameters[0] = MaterialParameter::compliance;
  record.fit.estimates(0) = 7e-5;
  record.options.free[0].prior = Prior{1e-5, 2e-5};
  EXPECT_TRUE(failed_tests(record).empty());
  record.fit.estimates(0) = 8e-5;
  record.fit.standard_errors(0) = 1e-6;
  EXPECT_TRUE(says(record, "3.5 standard deviations from what was known of it"));
  options.free[0].upper = 3.0;
  options.free[0].lower = 1.5;
  EXPECT_TRUE(says(record_of(good, line, options), "modulus ended at a bound"));
}

/// Two presses whose models share an error: the first misses all of its forces, the second differs
/// by noise alone. Together the error they share takes half of the miss off the first and puts it
/// on the second, whose noise would then keep one sign.
TEST(FitVerdict, OrderIsSoughtPressByPress) {
  constexpr Eigen::Index points = 20;
  FitRecord record;
  record.curves.resize(2);
  for (Curve& curve : record.curves) curve.sigma.assign(points, 0.1);
  VectorXd noise(points);
  for (Eigen::Index i = 0; i < points; ++i) noise(i) = (i % 2 == 0 ? 0.1 : -0.1);
  VectorXd trend = VectorXd::LinSpaced(points, -0.9, 1.1);
  record.fit.residuals = {trend, noise};
  record.options.model_covariance = MatrixXd::Constant(2 * points, 2 * points, 1.0);
  EXPECT_EQ(structure_of(record, 1).runs, points);
  EXPECT_LT(structure_of(record, 0).probability, 1e-4);
  record.fit.residuals[0] = VectorXd::Constant(points, 1.0);
  EXPECT_EQ(structure_of(record, 1).runs, points);
  // What the first misses by is the error that is known: it keeps its sign, and is no order.
  record.fit.residuals[0] += noise;
  EXPECT_EQ(structure_of(record, 0).runs, points);
}

/// Where Poisson's ratio ends at its bound it is named, not E.
TEST(FitVerdict, NamesPoissonsRatioAtItsBound) {
  Curve data;
  for (int i = 1; i <= 6; ++i) {
    data.x.push_back(0.1 * i);
    data.y.push_back(1000.0 * (4.0 * 0.1 * i + 3.06 * std::pow(0.1 * i, 2)));
  }
  FormulaModel model([&](const VectorXd& p) {
    MatrixXd design(6, 2);
    for (Index i = 0; i < 6; ++i) {
      const double x = data.x[std::size_t(i)];
      design.row(i) << x * x, 4.0 * x;
    }
    return CurveSlopes{design * p, design};
  });
  CurveFitOptions options;
  options.free = {{.parameter = youngs_modulus, .start = 2000.0},
                  {.parameter = shear_modulus, .start = 900.0}};
  options.highest_poissons_ratio = 0.45;
  const FitRecord record = record_of(data, model, options);
  ASSERT_TRUE(record.fit.poissons_ratio_bound);
  EXPECT_NEAR(*record.fit.poissons_ratio_bound, 0.45, 1e-9);
  EXPECT_TRUE(says(record, "Poisson's ratio ended at a bound, 0.45"));
  EXPECT_EQ(fit_statement(record).find("at its bound)"), std::string::npos);
}
