/// The model of a rig against presses whose travel has a closed form.
#include "calibration/press_fit/rig_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "calibration/statistics/curve_fit.h"
#include "meshes/base/errors.h"

using namespace fingertip;
using namespace fingertip::calibration;
using Eigen::Index;
using Eigen::VectorXd;
using enum MaterialParameter;

namespace {

/// F = E shape(delta).
class ProportionalPress final : public ForwardModel {
 public:
  ProportionalPress(std::vector<double> depths, std::function<double(double)> shape)
      : depths_(std::move(depths)), shape_(std::move(shape)) {}
  CurveSlopes evaluate(const VectorXd& parameters) override {
    CurveSlopes result{VectorXd(Index(depths_.size())), {}};
    for (std::size_t i = 0; i < depths_.size(); ++i)
      result.value(Index(i)) = parameters(0) * shape_(depths_[i]);
    result.jacobian = result.value / parameters(0);
    return result;
  }

 private:
  std::vector<double> depths_;
  std::function<double(double)> shape_;
};

constexpr double deepest = 4e-3, modulus_value = 2e5, offset = 0.28e-3, soft = 1e-4;
/// [m²]: Hertz' 4/3 sqrt(R)/(1 - nu²).
constexpr double hertz_factor = 0.16;
double hertz(double delta) {
  return hertz_factor * std::pow(delta, 1.5);
}
/// A layer that stiffens.
double stiffening(double delta) {
  return hertz(delta) * (1.0 + delta / 8e-3 + std::pow(delta / 6e-3, 2.0));
}

/// Travels at which a press with these parameters has the forces of `deltas`: no root is sought.
std::vector<double> travels(const std::vector<double>& deltas,
                            const std::function<double(double)>& shape) {
  std::vector<double> x;
  for (const double delta : deltas)
    x.push_back(offset + delta + soft * modulus_value * shape(delta));
  return x;
}

std::vector<double> even(int count, double last) {
  std::vector<double> list;
  for (int i = 1; i <= count; ++i) list.push_back(last * i / count);
  return list;
}

const Rig all_free{{0.0, 1}, {0.0, 2}, {0.0, 3}, {0.0, 4}};

VectorXd truth(double zero = 0.0, double drift = 0.0) {
  VectorXd p(5);
  p << modulus_value, offset, soft, zero, drift;
  return p;
}

TEST(RigModel, IsExactForHertz) {
  const auto depths = depths_for_rig(deepest);
  ProportionalPress press(depths, hertz);
  // From far below the first depth to beyond the last one: a power goes on as a power.
  const std::vector<double> deltas = {1e-6, 2e-5, 3e-4, 1.1e-3, 2.5e-3, 3.9e-3, 5e-3};
  RigModel model(press, depths, 1, {{offset, {}}, {soft, {}}, {}, {}}, travels(deltas, hertz), {},
                 1);
  const CurveSlopes found = model.evaluate(VectorXd::Constant(1, modulus_value));
  for (std::size_t i = 0; i < deltas.size(); ++i) {
    const double force = modulus_value * hertz(deltas[i]), slope = 1.5 * force / deltas[i];
    EXPECT_NEAR(found.value(Index(i)), force, 1e-10 * force);
    EXPECT_NEAR(model.indentation()(Index(i)), deltas[i], 1e-10 * deltas[i]);
    // E dF/dE of the press alone is F; the rig takes its share.
    EXPECT_NEAR(found.jacobian(Index(i), 0) * modulus_value, force / (1.0 + soft * slope),
                1e-9 * force);
  }
}

TEST(RigModel, InterpolatesAPressThatStiffens) {
  const auto depths = depths_for_rig(deepest);
  ProportionalPress press(depths, stiffening);
  const std::vector<double> deltas = even(57, deepest);
  RigModel model(press, depths, 1, {{offset, {}}, {soft, {}}, {}, {}}, travels(deltas, stiffening),
                 {}, 1);
  const CurveSlopes found = model.evaluate(VectorXd::Constant(1, modulus_value));
  for (std::size_t i = 0; i < deltas.size(); ++i) {
    const double force = modulus_value * stiffening(deltas[i]);
    EXPECT_NEAR(found.value(Index(i)), force, 1e-4 * force) << deltas[i];
  }
}

namespace {

void expect_slopes_of_differences(RigModel& model, const VectorXd& at) {
  const CurveSlopes here = model.evaluate(at);
  for (Index j = 0; j < at.size(); ++j) {
    const double step = 1e-6 * at(j);
    VectorXd up = at, down = at;
    up(j) += step;
    down(j) -= step;
    const VectorXd slope = (model.evaluate(up).value - model.evaluate(down).value) / (2.0 * step);
    EXPECT_LT((slope - here.jacobian.col(j)).norm(), 1e-6 * slope.norm()) << j;
  }
}

}  // namespace

TEST(RigModel, SlopesAreThoseOfDifferences) {
  const auto depths = depths_for_rig(deepest);
  ProportionalPress press(depths, stiffening);
  const std::vector<double> position = even(23, 1.2 * deepest);
  std::vector<double> time;
  for (const double x : position) time.push_back(1e3 * x);
  RigModel model(press, depths, 1, all_free, position, time, 5);
  expect_slopes_of_differences(model, truth(0.02, 1e-3));
}

/// A ramp at `speed` from touch at `start`, then held.
struct RampAndHold {
  double speed = 2e-3, start = 0.5, turn = 2.5;  ///< [m/s, s, s]
  double at(double t) const { return speed * (std::min(t, turn) - start); }
};

const std::vector<meshes::RelaxationBranch> two_branches = {{0.2, 0.3}, {0.15, 4.0}};

/// Lee & Radok's integral of Hertz' force over the ramp, by Simpson's rule in the root of time.
double faded_hertz(const RampAndHold& path, double t) {
  const meshes::Relaxation relaxation{two_branches, true};
  const double end = std::sqrt(std::min(t, path.turn) - path.start);
  constexpr int parts = 2000;
  double sum = 0.0;
  for (int i = 0; i <= parts; ++i) {
    // t' = start + u², d delta^1.5 = 1.5 v^1.5 u 2u du
    const double u = end * i / parts, weight = i == 0 || i == parts ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    sum += weight * relaxation.modulus(t - path.start - u * u) * 3.0 * u * u;
  }
  return modulus_value * hertz_factor * std::pow(path.speed, 1.5) * sum * end / parts / 3.0;
}

const std::vector<FitBranch> held_branches = {{{0.2}, {0.3}}, {{0.15}, {4.0}}};

TEST(RigModel, FadesAsLeeAndRadoksIntegral) {
  const auto depths = depths_for_rig(deepest);
  ProportionalPress press(depths, hertz);
  const RampAndHold path;
  for (const int steps : {15, 60}) {
    std::vector<double> time, position;
    for (int i = 0; i < steps; ++i) time.push_back(path.turn * (i + 1) / steps);
    for (const double t : {2.51, 2.6, 3.0, 5.0, 20.0}) time.push_back(t);
    for (const double t : time) position.push_back(path.at(t));
    RigModel model(press, depths, 1, {}, position, time, 1, held_branches);
    const VectorXd found = model.evaluate(VectorXd::Constant(1, modulus_value)).value;
    const double largest = faded_hertz(path, path.turn);
    for (std::size_t i = 0; i < time.size(); ++i)
      EXPECT_NEAR(found(Index(i)), position[i] > 0.0 ? faded_hertz(path, time[i]) : 0.0,
                  (steps == 15 ? 4e-4 : 3e-5) * largest)
          << time[i];
  }
}

/// Behind a machine that gives way the rubber creeps deeper while it is held.
TEST(RigModel, CreepsBehindASoftMachine) {
  const auto depths = depths_for_rig(deepest);
  ProportionalPress press(depths, hertz);
  const RampAndHold path;
  std::vector<double> time, position;
  for (int i = 1; i <= 400; ++i) time.push_back(0.02 * i);
  for (const double t : time) position.push_back(path.at(t));
  RigModel model(press, depths, 1, {{}, {soft, {}}, {}, {}}, position, time, 1, held_branches);
  const VectorXd found = model.evaluate(VectorXd::Constant(1, modulus_value)).value;
  const VectorXd deltas = model.indentation();
  for (std::size_t i = 0; i < time.size(); ++i) {
    const double told = deltas(Index(i)) + soft * found(Index(i));
    EXPECT_NEAR(told, std::max(0.0, position[i]), 1e-12);
  }
  EXPECT_GT(deltas(Index(time.size()) - 1), 1.005 * deltas(124));
  // What the machine then is told, pressed rigidly along the same way, is the same force.
  RigModel rigid(press, depths, 1, {}, {deltas.begin(), deltas.end()}, time, 1, held_branches);
  const VectorXd again = rigid.evaluate(VectorXd::Constant(1, modulus_value)).value;
  EXPECT_LT((again - found).norm(), 1e-4 * found.norm());
}

/// Modulus, touch, share and time from a ramp and hold with 0.2 % noise: unbiased, and as often
/// within their intervals as these say.
TEST(RigModel, AFitFindsWhatFadesAsOftenAsItSays) {
  const auto depths = depths_for_rig(1.1 * deepest);
  ProportionalPress press(depths, hertz);
  const RampAndHold path;
  Curve curve;
  curve.is_travel = curve.in_time = true;
  for (int i = 1; i <= 60; ++i) curve.time.push_back(path.turn * i / 60);
  for (int i = 1; i <= 20; ++i) curve.time.push_back(path.turn + 0.05 * i);
  for (const double t : curve.time) curve.x.push_back(path.at(t));
  const std::vector<FitBranch> truth_branches = {{{0.25}, {0.4}}};
  RigModel truth_model(press, depths, 1, {}, curve.x, curve.time, 1, truth_branches);
  const VectorXd exact = truth_model.evaluate(VectorXd::Constant(1, modulus_value)).value;
  const double sigma = 0.002 * exact.maxCoeff();
  curve.sigma.assign(curve.x.size(), sigma);
  RigModel model(press, depths, 1, {{0.0, 3}, {}, {}, {}}, curve.x, curve.time, 4,
                 {{{0.0, 1}, {0.0, 2}}});
  CurveFitOptions options;
  options.free = {{.parameter = modulus, .start = 1.3 * modulus_value},
                  {.parameter = relaxation_g1, .start = 0.15, .upper = 0.95, .scale = 0.2},
                  {.parameter = relaxation_tau1, .start = 1.0},
                  {.parameter = touch_offset, .start = 0.1e-3, .scale = deepest}};
  const std::vector<double> wanted = {modulus_value, 0.25, 0.4, 0.0};
  std::vector<int> within(4, 0);
  std::vector<double> sum(4, 0.0);
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, sigma);
  constexpr int fits = 200;
  for (int k = 0; k < fits; ++k) {
    curve.y.clear();
    for (const double force : exact) curve.y.push_back(force + normal(random));
    const CurveFit fit = fit_curves({curve}, {&model}, options);
    EXPECT_TRUE(fit.converged);
    for (std::size_t j = 0; j < 4; ++j) {
      within[j] += fit.lower(Index(j)) < wanted[j] && wanted[j] < fit.upper(Index(j)) ? 1 : 0;
      sum[j] += (fit.estimates(Index(j)) - wanted[j]) / fit.standard_errors(Index(j));
    }
  }
  for (std::size_t j = 0; j < 4; ++j) {
    EXPECT_GE(within[j], 180) << j;  // 190 expected, deviation 3
    EXPECT_NEAR(sum[j] / fits, 0.0, 0.3) << j;
  }
}

TEST(RigModel, SlopesOfAFadingPressAreThoseOfDifferences) {
  const auto depths = depths_for_rig(deepest);
  ProportionalPress press(depths, stiffening);
  std::vector<double> position = even(23, 1.2 * deepest), time;
  for (const double x : position) time.push_back(1e3 * x);
  for (int i = 0; i < 5; ++i)
    position.push_back(position.back()), time.push_back(time.back() + 1.0);
  const std::vector<FitBranch> branches = {{{0.0, 5}, {0.0, 6}}, {{0.0, 7}, {2.0, {}}}};
  RigModel model(press, depths, 1, all_free, position, time, 8, branches);
  VectorXd at(8);
  at << truth(0.02, 1e-3), 0.2, 0.7, 0.15;
  for (const double touch : {offset, 0.1e-3}) {  // within the first step and before it
    at(1) = touch;
    expect_slopes_of_differences(model, at);
  }
  at(5) = 0.9;
  EXPECT_THROW(model.evaluate(at), meshes::NotConverged);
  EXPECT_THROW(RigModel(press, depths, 1, {}, {1e-3, 2e-3}, {}, 1, held_branches),
               meshes::InvalidInput);
}

TEST(RigModel, HasTheZeroOfItsLoadCellAloneBeforeTouch) {
  const auto depths = depths_for_rig(deepest);
  ProportionalPress press(depths, hertz);
  RigModel model(press, depths, 1, all_free, {-1e-3, 0.1e-3, offset}, {0.0, 5.0, 10.0}, 5);
  const CurveSlopes found = model.evaluate(truth(0.02, 1e-3));
  EXPECT_DOUBLE_EQ(found.value(0), 0.02);
  EXPECT_DOUBLE_EQ(found.value(1), 0.025);
  EXPECT_DOUBLE_EQ(found.value(2), 0.03);
  EXPECT_EQ(found.jacobian.leftCols(3).norm(), 0.0);
}

TEST(RigModel, PassesOverDepthsWithoutForce) {
  const auto depths = depths_for_rig(deepest);
  const auto late = [](double delta) { return delta < 2e-4 ? 0.0 : hertz(delta); };
  ProportionalPress press(depths, late);
  RigModel model(press, depths, 1, {{0.0, {}}, {soft, {}}, {}, {}},
                 {1e-3 + soft * modulus_value * hertz(1e-3)}, {}, 1);
  const double force = modulus_value * hertz(1e-3);
  EXPECT_NEAR(model.evaluate(VectorXd::Constant(1, modulus_value)).value(0), force, 1e-9 * force);
  ProportionalPress none(depths, [](double) { return 0.0; });
  RigModel empty(none, depths, 1, {}, {1e-3}, {}, 1);
  EXPECT_THROW(empty.evaluate(VectorXd::Constant(1, modulus_value)), meshes::NotConverged);
}

TEST(RigModel, RefusesARigThatGivesBackTooMuch) {
  const auto depths = depths_for_rig(deepest);
  ProportionalPress press(depths, hertz);
  const double stiffness = 1.5 * modulus_value * hertz(deepest) / deepest;
  RigModel model(press, depths, 1, {{0.0, {}}, {-1.01 / stiffness, {}}, {}, {}}, {deepest}, {}, 1);
  EXPECT_THROW(model.evaluate(VectorXd::Constant(1, modulus_value)), meshes::NotConverged);
}

TEST(RigModel, RefusesWhatDoesNotFit) {
  const auto depths = depths_for_rig(deepest);
  ProportionalPress press(depths, hertz);
  EXPECT_THROW(RigModel(press, {1e-3}, 1, {}, {1e-3}, {}, 1), meshes::InvalidInput);
  EXPECT_THROW(RigModel(press, {2e-3, 1e-3}, 1, {}, {1e-3}, {}, 1), meshes::InvalidInput);
  EXPECT_THROW(RigModel(press, depths, 1, {}, {1e-3, 2e-3}, {1.0}, 1), meshes::InvalidInput);
  EXPECT_THROW(RigModel(press, depths, 1, {{0.0, 0}, {}, {}, {}}, {1e-3}, {}, 1),
               meshes::InvalidInput);
  EXPECT_THROW(RigModel(press, depths, 1, {{0.0, 1}, {}, {}, {}}, {1e-3}, {}, 1),
               meshes::InvalidInput);
}

/// Modulus, offset, compliance and the cell's zero from forces without noise, of two files of one
/// rig.
TEST(RigModel, AFitFindsWhatItsDataWereMadeOf) {
  const auto depths = depths_for_rig(1.3 * deepest);
  ProportionalPress first(depths, stiffening), second(depths, hertz);
  std::vector<Curve> curves(2);
  for (int c = 0; c < 2; ++c) {
    const auto shape = c == 0 ? stiffening : hertz;
    std::vector<double> deltas = even(40, deepest);
    curves[std::size_t(c)].x = travels(deltas, shape);
    for (const double delta : deltas)
      curves[std::size_t(c)].y.push_back(0.05 + modulus_value * shape(delta));
    curves[std::size_t(c)].is_travel = true;
    curves[std::size_t(c)].sigma.assign(40, 1e-3);
  }
  RigModel one(first, depths, 1, {{0.0, 1}, {0.0, 3}, {0.05, {}}, {}}, curves[0].x, {}, 4);
  RigModel two(second, depths, 1, {{0.0, 2}, {0.0, 3}, {0.05, {}}, {}}, curves[1].x, {}, 4);
  CurveFitOptions options;
  options.free = {{.parameter = modulus, .start = 1e5},
                  {.parameter = touch_offset, .scale = deepest, .of = "one"},
                  {.parameter = touch_offset, .scale = deepest, .of = "two"},
                  {.parameter = compliance, .scale = 1e-3}};
  const CurveFit fit = fit_curves(curves, {&one, &two}, options);
  ASSERT_TRUE(fit.converged);
  EXPECT_NEAR(fit.estimates(0), modulus_value, 1e-3 * modulus_value);
  EXPECT_NEAR(fit.estimates(1), offset, 2e-3 * offset);
  EXPECT_NEAR(fit.estimates(2), offset, 2e-3 * offset);
  EXPECT_NEAR(fit.estimates(3), soft, 1e-3 * soft);
  EXPECT_EQ(fit.labels[2], "touch_offset (two)");
}

}  // namespace
