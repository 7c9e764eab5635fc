/// A solid finger of 12.5 mm radius on a cylinder of 20 mm, behind a rig, with known truth: law A,
/// E = 200 kPa, nu = 0.45, frictionless, 40 forces to 4 mm with errors of 1 %, touched at 0.28 mm
/// on a machine that gives way by 0.1 mm/N. The forces are the continuum's
/// (tests/calibration/data, response.csv of `fingertip reference` with reference.strain = finite on
/// studies/examples/solid_finger.csv): of one run at the 40 depths of the data (tolerance 1 %; on
/// the ball of 5 mm, to 2.5 mm, 0.2 %), and of another at depths_for_rig (2 %).
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <random>

#include "calibration/press_fit/fit_record.h"
#include "calibration/press_fit/rig_model.h"
#include "calibration/statistics/curve_fit.h"
#include "calibration/statistics/design.h"
#include "meshes/press/press_response.h"

using namespace fingertip;
using namespace fingertip::calibration;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double truth = 200e3, touch = 0.28e-3, frame = 1e-4, noise = 0.01;
constexpr int seeds = 50;

struct Table {
  std::vector<double> depths, forces;

  explicit Table(const std::string& name) {
    const auto response = meshes::PressResponse::read_csv(
        std::filesystem::path(FINGERTIP_PRESS_DATA) / (name + ".csv"));
    for (const auto& sample : response.samples()) {
      depths.push_back(sample.indentation);
      forces.push_back(sample.normal_force);
    }
  }
};

/// F = E/E0 times the table's.
class TableModel final : public ForwardModel {
 public:
  explicit TableModel(const Table& table)
      : forces_(VectorXd::Map(table.forces.data(), Index(table.forces.size()))) {}
  CurveSlopes evaluate(const VectorXd& parameters) override {
    return {forces_ * (parameters(0) / truth), forces_ / truth};
  }

 private:
  VectorXd forces_;
};

/// A press, what is measured of it and what answers for it.
struct Press {
  Table fine, table;
  TableModel model{table};

  explicit Press(const std::string& name) : fine(name + "_truth"), table(name) {}

  /// Without noise for the seed 0.
  Curve measured(unsigned seed) const {
    std::mt19937 random(seed);
    std::normal_distribution<double> deviate(0.0, seed == 0 ? 0.0 : noise);
    Curve curve;
    curve.name = "press " + std::to_string(fine.depths.back());
    curve.is_travel = true;
    for (std::size_t i = 0; i < fine.depths.size(); ++i) {
      const double force = fine.forces[i];
      curve.x.push_back(touch + fine.depths[i] + frame * force);
      curve.y.push_back(force * (1.0 + deviate(random)));
      curve.sigma.push_back(noise * force);
    }
    return curve;
  }
  std::unique_ptr<RigModel> behind(const Rig& rig, const Curve& curve, Index parameters) {
    return std::make_unique<RigModel>(model, table.depths, 1, rig, curve.x, std::vector<double>(),
                                      parameters);
  }
};

const FreeParameter free_modulus{.parameter = MaterialParameter::modulus, .start = 150e3},
    free_touch{.parameter = MaterialParameter::touch_offset, .start = 0.1e-3, .scale = 4e-3},
    free_frame{.parameter = MaterialParameter::compliance, .start = 2e-5, .scale = 5e-4};

struct FingerRig : testing::Test {
  Press cylinder{"finger_on_cylinder"}, ball{"finger_on_ball"};

  CurveFit on_cylinder(unsigned seed, bool frame_fitted, FitRecord* record = nullptr) {
    CurveFitOptions options;
    options.free = {free_modulus, free_touch};
    Rig rig{{0.0, 1}, {frame, {}}, {}, {}};
    if (frame_fitted) {
      options.free.push_back(free_frame);
      rig.compliance.place = 2;
    }
    const std::vector<Curve> curves = {cylinder.measured(seed)};
    const auto model = cylinder.behind(rig, curves[0], Index(options.free.size()));
    const CurveFit fit = fit_curves(curves, {model.get()}, options);
    if (record != nullptr) {
      record->fit = fit;
      record->curves = curves;
      record->conditions = {""};
      record->options = options;
    }
    return fit;
  }
  CurveFit on_both(unsigned seed) {
    CurveFitOptions options;
    FreeParameter second = free_touch;
    second.of = "ball";
    options.free = {free_modulus, free_touch, free_frame, second};
    const std::vector<Curve> curves = {cylinder.measured(seed), ball.measured(seed + 1000)};
    const auto one = cylinder.behind({{0.0, 1}, {0.0, 2}, {}, {}}, curves[0], 4),
               two = ball.behind({{0.0, 3}, {0.0, 2}, {}, {}}, curves[1], 4);
    return fit_curves(curves, {one.get(), two.get()}, options);
  }
  /// What `fit`, to the cylinder's press with the compliance free, tells of a press on the ball.
  VectorXd told(const CurveFit& fit) {
    const Curve first = cylinder.measured(0), second = ball.measured(0);
    const auto one = cylinder.behind({{0.0, 1}, {0.0, 2}, {}, {}}, first, 4),
               two = ball.behind({{0.0, 3}, {0.0, 2}, {}, {}}, second, 4);
    VectorXd at(4);
    at << fit.estimates, touch;
    const CurveSlopes a = one->evaluate(at), b = two->evaluate(at);
    MatrixXd jacobian(a.value.size() + b.value.size(), 4);
    jacobian << a.jacobian, b.jacobian;
    VectorXd sigma(jacobian.rows());
    sigma << noise * a.value, noise * b.value;
    const MatrixXd with = predicted_covariance({jacobian, sigma, {}},
                                               {free_modulus, free_touch, free_frame, free_touch});
    return fit.standard_errors.cwiseQuotient(with.diagonal().head(3).cwiseSqrt());
  }
};

}  // namespace

TEST_F(FingerRig, WithTheComplianceKnownTheModulusIsFound) {
  int covered = 0;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const CurveFit fit = on_cylinder(seed, false);
    ASSERT_TRUE(fit.converged);
    EXPECT_NEAR(fit.estimates(0), truth, 0.02 * truth) << seed;
    covered += fit.lower(0) <= truth && truth <= fit.upper(0);
  }
  EXPECT_GE(covered, 45);
  RecordProperty("covered", covered);
}

TEST_F(FingerRig, AFittedComplianceIsToldAsNearlyCollinear) {
  FitRecord record;
  const CurveFit fit = on_cylinder(1, true, &record);
  const std::string said = fit_statement(record);
  EXPECT_NE(said.find("modulus and compliance are nearly collinear"), std::string::npos) << said;
  const auto pairs = nearly_collinear(fit.covariance);
  ASSERT_FALSE(pairs.empty());
  EXPECT_EQ(fit.labels[pairs[0].first], "modulus");
  EXPECT_EQ(fit.labels[pairs[0].second], "compliance");
  const CurveFit known = on_cylinder(1, false);
  EXPECT_NEAR(fit.standard_errors(0) / known.standard_errors(0), pairs[0].times,
              0.1 * pairs[0].times);
}

TEST_F(FingerRig, ABallNarrowsTheIntervalAsWasTold) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const CurveFit first = on_cylinder(seed, true), both = on_both(seed);
    const VectorXd factors = told(first);
    for (const Index i : {0, 2}) {
      const double found = first.standard_errors(i) / both.standard_errors(i);
      EXPECT_GT(found, 1.2);
      EXPECT_NEAR(factors(i), found, 0.3 * found) << seed;
    }
    EXPECT_LE(both.lower(0), truth * 1.01);
    EXPECT_GE(both.upper(0), truth * 0.99);
  }
}
