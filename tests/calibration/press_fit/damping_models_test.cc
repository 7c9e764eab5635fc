/// Tests of damping: against Kelvin's and Voigt's element integrated in time, the lattice's own
/// damping, the moving lattice and the transient continuum; each recovers tau from its own data.
#include "calibration/press_fit/damping_models.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "calibration/statistics/curve_fit.h"
#include "lattice/dynamics/finger.h"
#include "lattice/dynamics/time_step.h"
#include "lattice/forces/forces.h"
#include "lattice/press/static_press.h"
#include "meshes/base/errors.h"
#include "meshes/press/press_motion.h"
#include "tests/calibration/fit_fixtures.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fingertip::calibration;
using Eigen::Index;
using Eigen::VectorXd;
using meshes::ContactMode;
using meshes::Vector3;

namespace {

VectorXd vector_of(double value) {
  return VectorXd::Constant(1, value);
}

void expect_slopes_of_differences(ForwardModel& model, double tau) {
  const double step = 1e-4 * tau;
  const VectorXd slope =
      (model.evaluate(vector_of(tau + step)).value - model.evaluate(vector_of(tau - step)).value) /
      (2.0 * step);
  const VectorXd found = model.evaluate(vector_of(tau)).jacobian;
  EXPECT_LT((found - slope).cwiseAbs().maxCoeff(), 1e-7 * found.cwiseAbs().maxCoeff());
}

Curve measured(ForwardModel& model, double tau, const std::vector<double>& x, double sigma,
               unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal(0.0, sigma);
  Curve curve{.name = "", .x = x, .y = {}, .sigma = std::vector<double>(x.size(), sigma)};
  for (const double value : model.evaluate(vector_of(tau)).value)
    curve.y.push_back(value + normal(generator));
  return curve;
}

CurveFit fit_time(const Curve& curve, ForwardModel& model, double start) {
  CurveFitOptions options;
  options.free = {{.parameter = MaterialParameter::retardation_time, .start = start}};
  return fit_curves({curve}, {&model}, options);
}

lattice::PressSetup press(ContactMode contact, int per_radius, double speed) {
  lattice::PressSetup setup;
  setup.lattice.spacing = setup.geometry.tip_radius / per_radius;
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  setup.protocol.contact = contact;
  setup.protocol.speed = speed;
  setup.threads = 1;
  return setup;
}

meshes::PressResponse static_press(lattice::PressSetup setup, const std::vector<double>& depths) {
  setup.protocol.depth = depths.back();
  setup.protocol.samples = depths;
  return lattice::run_static_press(setup).response;
}

std::vector<double> evenly(double last, int count) {
  std::vector<double> values;
  for (int i = 1; i <= count; ++i) values.push_back(last * i / count);
  return values;
}

/// Bond force against the plane's normal at increasing times since first touch; the rod runs at the
/// setup's speed and stops at once after `duration`.
VectorXd ramp_and_hold(const lattice::PressSetup& setup, double duration,
                       const std::vector<double>& times) {
  const lattice::LatticeModel model =
      lattice::build_tip(setup.geometry, setup.rubber, setup.lattice);
  const meshes::PressProtocol& protocol = setup.protocol;
  const lattice::PressPlane reference = lattice::press_plane(protocol, setup.geometry);
  const lattice::Plane plane{reference.point(-protocol.clearance), reference.normal};
  const lattice::StepController steps(model, nullptr, setup.integrator, {});
  lattice::Finger finger(model, lattice::rod_body(setup.geometry, setup.rod), plane,
                         protocol.contact, setup.integrator, steps.divide(1e-3, {}), 1);
  const meshes::PressMotion approach(protocol);
  const double touch = approach.touch_time(), stop = touch + duration;
  VectorXd force(Index(times.size()));
  for (std::size_t next = 0; next < times.size();) {
    const double start = finger.time(), end = start + finger.step();
    const meshes::SetPoint at = approach.at(std::min(end, stop));
    finger.advance(lattice::RodMotion{
        -at.distance * plane.normal,
        end < stop ? Vector3(-at.speed * plane.normal) : Vector3(Vector3::Zero())});
    if (start >= touch + times[next] - 0.5 * finger.step())
      force(Index(next++)) = finger.bond().force.dot(plane.normal);
  }
  return force;
}

}  // namespace

/// stress = E (strain + tau rate), by small steps.
TEST(DampingModels, AreKelvinsAndVoigtsElement) {
  const double tau = 2e-3, dt = 1e-7;
  CreepModel creep({tau, 3.0 * tau});
  const VectorXd expected = creep.evaluate(vector_of(tau)).value;
  double strain = 0.0;
  for (int n = 1; n <= 60000; ++n) {
    const double middle = strain + 0.5 * dt * (1.0 - strain) / tau;
    strain += dt * (1.0 - middle) / tau;
    if (n == 20000) {
      EXPECT_NEAR(strain, expected(0), 1e-8);
    }
  }
  EXPECT_NEAR(strain, expected(1), 1e-8);
  // Loss over a cycle is pi sin d times the amplitudes of stress and strain.
  const double f = 30.0, omega = 2.0 * std::numbers::pi * f;
  double loss = 0.0, largest = 0.0;
  constexpr int steps = 20000;
  for (int n = 0; n < steps; ++n) {
    const double phase = 2.0 * std::numbers::pi * n / steps;
    const double stress = std::sin(phase) + tau * omega * std::cos(phase);
    loss += stress * std::cos(phase) * 2.0 * std::numbers::pi / steps;
    largest = std::max(largest, stress);
  }
  const double lag = std::asin(loss / (std::numbers::pi * largest));
  EXPECT_NEAR(LossFactorModel({f}).evaluate(vector_of(tau)).value(0), std::tan(lag), 1e-6);
}

TEST(DampingModels, SlopesEqualDifferences) {
  const double tau = 3e-4;
  LossFactorModel loss({1.0, 50.0});
  CreepModel creep({1e-5, 2e-4, 5e-4, 2e-3, 1.0});
  expect_slopes_of_differences(loss, tau);
  expect_slopes_of_differences(creep, tau);
  const StaticForce hertz = [](double d) {
    return ForceAndStiffness{3e3 * std::pow(d, 1.5), 4.5e3 * std::sqrt(d)};
  };
  RampModel ramp({0.02, 0.1, 0.11}, {.speed = 0.01, .duration = 0.1}, hertz);
  expect_slopes_of_differences(ramp, tau);
  // At tau = 0 creep is at its end at once.
  EXPECT_EQ(creep.evaluate(vector_of(0.0)).value, VectorXd::Ones(5));
  EXPECT_EQ(creep.evaluate(vector_of(0.0)).jacobian.norm(), 0.0);
  EXPECT_TRUE(creep.evaluate(vector_of(1e-300)).jacobian.allFinite());
}

TEST(RampModel, JumpsWhereThePlaneStopsAndDoesNotRelax) {
  const StaticForce hertz = [](double d) {
    return ForceAndStiffness{3e3 * std::pow(d, 1.5), 4.5e3 * std::sqrt(d)};
  };
  const double tau = 2e-3, v = 0.01, end = 0.1, depth = v * end;
  const VectorXd force = RampModel({0.5 * end, end, 1.0001 * end, 5.0}, {v, end}, hertz)
                             .evaluate(vector_of(tau))
                             .value;
  EXPECT_DOUBLE_EQ(force(0),
                   3e3 * std::pow(0.5 * depth, 1.5) + tau * v * 4.5e3 * std::sqrt(0.5 * depth));
  EXPECT_DOUBLE_EQ(force(1), 3e3 * std::pow(depth, 1.5) + tau * v * 4.5e3 * std::sqrt(depth));
  EXPECT_DOUBLE_EQ(force(2), 3e3 * std::pow(depth, 1.5));
  EXPECT_EQ(force(3), force(2));
}

TEST(InterpolatedForce, ConvergesAtLeastWithTheSquareOfTheDistance) {
  const auto error = [](int count) {
    meshes::PressResponse response;
    for (const double d : evenly(1.0, count)) response.append({d, d * d * std::exp(d)});
    const StaticForce force = interpolated_force(response);
    double worst = 0.0;
    for (double d = 0.013; d < 1.0; d += 0.021)
      worst = std::max(worst, std::abs(force(d).stiffness - (2.0 * d + d * d) * std::exp(d)));
    EXPECT_NEAR(force(1.0).force, std::exp(1.0), 1e-12);
    EXPECT_EQ(force(-0.1).force, 0.0);
    return worst;
  };
  EXPECT_LT(error(80), 1e-2);
  EXPECT_GT(error(40) / error(80), 3.5);
}

/// Of 200 repeated measurements the 95 % interval holds the truth 190 times, give or take 9 (three
/// standard deviations of the binomial distribution).
TEST(DampingFit, EachTestRecoversTheTime) {
  const double tau = 3e-4;
  const auto expect_coverage = [&](ForwardModel& model, const std::vector<double>& x, double sigma,
                                   double start) {
    int inside = 0;
    for (unsigned seed = 1; seed <= 200; ++seed) {
      const CurveFit fit = fit_time(measured(model, tau, x, sigma, seed), model, start);
      inside += fit.lower(0) < tau && tau < fit.upper(0) ? 1 : 0;
      ASSERT_LT(fit.standard_errors(0), 0.1 * tau);
      ASSERT_TRUE(fit.unidentifiable.empty());
    }
    EXPECT_NEAR(inside, 190, 9);
  };
  const std::vector<double> frequencies = {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0};
  LossFactorModel loss(frequencies);
  expect_coverage(loss, frequencies, 0.003, 1e-3);
  const std::vector<double> times = evenly(2e-3, 20);
  CreepModel creep(times);
  expect_coverage(creep, times, 0.01, 1e-4);
  const lattice::PressSetup setup = press(ContactMode::frictionless, 6, 0.05);
  const std::vector<double> instants = evenly(0.04, 40);  // half of it a ramp to 0.1 cm
  RampModel ramp(instants, {setup.protocol.speed, 0.02},
                 interpolated_force(static_press(setup, evenly(1e-3, 20))));
  expect_coverage(ramp, instants, 5e-5, 1e-3);
}

/// Any motion of the lattice about rest stores -f·u/2 as displacement and loses -f·v as velocity.
TEST(DampingFit, LossFactorsOfTheLatticeGiveItsTime) {
  const double tau = 7e-4;
  const std::vector<double> frequencies = {3.0, 10.0, 30.0, 100.0};
  for (const auto& [kind, kinematics] :
       {std::pair{lattice::ModelKind::hookean, lattice::Kinematics::small},
        {lattice::ModelKind::network, lattice::Kinematics::finite},
        {lattice::ModelKind::central, lattice::Kinematics::small}}) {
    const lattice::LatticeModel model = fixtures::block(kind, kinematics, {3, 4, 3}, tau);
    lattice::Team team(1);
    lattice::InternalForces forces(model, team);
    Curve curve{.name = "", .x = frequencies, .y = {}, .sigma = {}};
    for (std::size_t i = 0; i < frequencies.size(); ++i) {
      double stored = 0.0, lost = 0.0;
      for (const double sign : {1.0, -1.0}) {  // what is even in the amplitude drops out
        const lattice::State random = fixtures::random_state(model, sign * 1e-5, 0.0, unsigned(i));
        lattice::State displaced(model), moving(model);
        displaced.displacement = moving.velocity = random.displacement;
        lattice::VectorField elastic(model.points()), viscous(model.points());
        forces.accumulate(displaced, elastic);
        forces.accumulate(moving, viscous);
        for (const std::size_t p : model.particles) {
          stored -= elastic.at(p).dot(random.displacement.at(p));
          lost -= viscous.at(p).dot(random.displacement.at(p));
        }
      }
      curve.y.push_back(2.0 * std::numbers::pi * frequencies[i] * lost / stored);
    }
    LossFactorModel loss(frequencies);
    EXPECT_NEAR(fit_time(curve, loss, 1e-3).estimates(0) / tau, 1.0, 1e-6) << name(kind);
  }
}

/// Slow enough for inertia, damped enough to see it: the surplus is up to 8 % of the force.
TEST(RampModel, IsWhatTheMovingLatticeDoes) {
  for (const ContactMode contact : {ContactMode::frictionless, ContactMode::stick}) {
    lattice::PressSetup setup = press(contact, 5, 0.01);
    setup.rubber.retardation_time = 3e-3;
    const std::vector<double> times = {0.04, 0.06, 0.08, 0.0999, 0.14, 0.15};
    const Ramp ramp{setup.protocol.speed, 0.1};
    const StaticForce elastic = interpolated_force(static_press(setup, evenly(1e-3, 50)));
    const CurveSlopes model = RampModel(times, ramp, elastic).evaluate(vector_of(3e-3));
    const VectorXd moving = ramp_and_hold(setup, ramp.duration, times);
    for (Index i = 0; i < moving.size(); ++i) {
      EXPECT_NEAR(moving(i) / model.value(i), 1.0, 0.01) << name(contact) << " " << i;
      if (i < 4) {
        EXPECT_GT(3e-3 * model.jacobian(i, 0) / model.value(i), 0.03);
      }
    }
  }
}

/// Where points touch at other steps of time the force jumps by about 1e-5 of itself, which a
/// narrow difference makes large: so wide ones show the order, and the usual one is compared with
/// them.
TEST(MovingPressModel, SlopeConvergesWithTheSquareOfTheStep) {
  lattice::PressSetup setup = press(ContactMode::frictionless, 6, 0.05);
  setup.protocol.clearance = 5e-3;
  setup.rubber.retardation_time = 5e-4;
  const std::vector<double> depths = {4e-4, 7e-4, 10e-4};
  const auto slope = [&](double step) {
    return VectorXd(MovingPressModel(setup, depths, step).evaluate(vector_of(3e-4)).jacobian);
  };
  const VectorXd wide = slope(0.4), middle = slope(0.2), narrow = slope(0.1),
                 usual = slope(MovingPressModel::default_step);
  EXPECT_NEAR((wide - middle).norm() / (middle - narrow).norm(), 4.0, 0.6);
  const VectorXd extrapolated = narrow + (narrow - middle) / 3.0;
  EXPECT_LT((extrapolated - usual).norm(), 5e-3 * usual.norm());
}

/// Moving over static force, so that the grid's own error drops out; the continuum's forces (gf)
/// are those of its transient press, 3.261 and 2.444 at 0.1 cm over 3.257 at rest, 19.558
/// and 20.182 at 0.3 cm over 19.426.
TEST(MovingPressModel, DrivesTheRodLikeTheTransientContinuum) {
  const std::vector<double> depths = {1e-3, 3e-3};
  for (const auto& [speed, shallow, deep] :
       {std::tuple{0.05, 3.261 / 3.257, 19.558 / 19.426}, {0.2, 2.444 / 3.257, 20.182 / 19.426}}) {
    lattice::PressSetup setup = press(ContactMode::frictionless, 6, speed);
    setup.protocol.clearance = 0.1 * speed;
    const VectorXd moving =
        MovingPressModel(setup, depths).evaluate(vector_of(setup.rubber.retardation_time)).value;
    const auto rest = static_press(setup, depths);
    EXPECT_NEAR(moving(0) / rest.samples()[0].normal_force, shallow, 0.015) << speed;
    EXPECT_NEAR(moving(1) / rest.samples()[1].normal_force, deep, 0.012) << speed;
  }
}

TEST(DampingFit, AMovingPressGivesTheTimeOfAnother) {
  const double tau = 4e-4;
  lattice::PressSetup setup = press(ContactMode::frictionless, 4, 0.05);
  setup.protocol.clearance = 1e-3;
  setup.rubber.retardation_time = 5e-4;  // none larger is expected
  const std::vector<double> depths = evenly(8e-4, 6);
  MovingPressModel model(setup, depths);
  const CurveFit fit = fit_time(measured(model, tau, depths, 5e-5, 6), model, 2e-4);
  EXPECT_LT(fit.lower(0), tau);
  EXPECT_GT(fit.upper(0), tau);
  EXPECT_LT(fit.standard_errors(0), 0.15 * tau);
  // Without noise, by Gauss and Newton's steps from afar.
  const VectorXd exact = model.evaluate(vector_of(tau)).value;
  double found = 2e-4;
  for (int i = 0; i < 4; ++i) {
    const CurveSlopes now = model.evaluate(vector_of(found));
    const VectorXd slope = now.jacobian.col(0);
    found += slope.dot(exact - now.value) / slope.squaredNorm();
  }
  EXPECT_NEAR(found / tau, 1.0, 1e-3);
}

TEST(DampingModels, RefuseWhatTheyCannotBe) {
  const auto says = [](const std::function<void()>& action, const std::string& words) {
    const std::string text = refusal(action);
    EXPECT_NE(text.find(words), std::string::npos) << text;
  };
  says([] { LossFactorModel({0.0}); }, "positive");
  says([] { CreepModel({std::nan("")}); }, "positive");
  LossFactorModel loss({1.0});
  says([&] { loss.evaluate(vector_of(-1e-3)); }, "not negative");
  says([&] { loss.evaluate(VectorXd::Ones(2)); }, "one parameter");
  meshes::PressResponse response;
  response.append({1e-3, 1.0});
  response.append({2e-3, 3.0});
  says([&] { interpolated_force(response); }, "at least three");
  response.append({2e-3, 4.0});
  says([&] { interpolated_force(response); }, "increase");
  meshes::PressResponse good;
  for (const double d : evenly(1e-3, 5)) good.append({d, d});
  const StaticForce force = interpolated_force(good);
  says([&] { RampModel({0.2}, {0.01, 0.2}, force); }, "ends at 0.001 m");
  says([&] { RampModel({0.2}, {0.0, 0.2}, force); }, "ramp.speed");
  lattice::PressSetup setup = press(ContactMode::stick, 6, 0.05);
  says([&] { MovingPressModel(setup, {}); }, "depths");
  says([&] { MovingPressModel(setup, {1e-3, 5e-4}); }, "samples");
  says([&] { MovingPressModel(setup, {1e-3}, 0.0); }, "difference");
  setup.lattice.model = lattice::ModelKind::published;
  says([&] { MovingPressModel(setup, {1e-3}); }, "do not know tau");
}
