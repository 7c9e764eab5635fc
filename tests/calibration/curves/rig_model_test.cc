/// The model of a rig against presses whose travel has a closed form.
#include "calibration/curves/rig_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "calibration/curves/curve_fit.h"
#include "meshes/errors.h"

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

TEST(RigModel, SlopesAreThoseOfDifferences) {
  const auto depths = depths_for_rig(deepest);
  ProportionalPress press(depths, stiffening);
  const std::vector<double> position = even(23, 1.2 * deepest);
  std::vector<double> time;
  for (const double x : position) time.push_back(1e3 * x);
  RigModel model(press, depths, 1, all_free, position, time, 5);
  const VectorXd at = truth(0.02, 1e-3);
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
