/// What a press behind a rig tells of its rubber, on data of a known truth: a finger of 12.5 mm
/// radius and 32.5 mm height on a plane and on a ball of 5 mm, after Dimitriadis et al. (Biophys.
/// J. 82, 2798, 2002), sphere on a bonded layer of nu = 1/2.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <random>

#include "calibration/press_fit/fit_record.h"
#include "calibration/press_fit/rig_model.h"
#include "calibration/statistics/curve_checks.h"
#include "calibration/statistics/curve_fit.h"
#include "calibration/statistics/score_tests.h"

using namespace fingertip::calibration;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using enum MaterialParameter;

namespace {

constexpr double modulus_value = 200e3, offset = 0.28e-3, soft = 1e-4;
constexpr double finger = 12.5e-3, ball = 5e-3, height = 32.5e-3, deepest = 4e-3;
constexpr double noise = 0.01;
constexpr int points = 40, seeds = 50;

/// F/E [m²].
double layer(double radius, double delta) {
  const double chi = std::sqrt(radius * delta) / height;
  return 16.0 / 9.0 * std::sqrt(radius) * std::pow(delta, 1.5) *
         (1.0 + chi * (1.133 + chi * (1.497 + chi * (1.469 + chi * 0.755))));
}

double radius_of(bool on_ball) {
  return on_ball ? 1.0 / (1.0 / finger + 1.0 / ball) : finger;
}

class Layer final : public ForwardModel {
 public:
  Layer(double radius, std::vector<double> depths) : radius_(radius), depths_(std::move(depths)) {}
  CurveSlopes evaluate(const VectorXd& parameters) override {
    CurveSlopes result{VectorXd(Index(depths_.size())), {}};
    for (std::size_t i = 0; i < depths_.size(); ++i)
      result.value(Index(i)) = parameters(0) * layer(radius_, depths_[i]);
    result.jacobian = result.value / parameters(0);
    return result;
  }

 private:
  double radius_;
  std::vector<double> depths_;
};

/// Forces at known travels with noise of 1 %, without noise for the seed 0.
Curve measured(bool on_ball, unsigned seed) {
  std::mt19937 random(seed + (on_ball ? 1000U : 0U));
  std::normal_distribution<double> deviate(0.0, seed == 0 ? 0.0 : noise);
  Curve curve;
  curve.name = on_ball ? "ball" : "plane";
  curve.is_travel = true;
  for (int i = 1; i <= points; ++i) {
    const double delta = deepest * i / points,
                 force = modulus_value * layer(radius_of(on_ball), delta);
    curve.x.push_back(offset + delta + soft * force);
    curve.y.push_back(force * (1.0 + deviate(random)));
    curve.sigma.push_back(noise * force);
  }
  return curve;
}

/// The plane's press, perhaps the ball's beside it.
struct Study {
  std::vector<Curve> curves;
  std::vector<std::unique_ptr<Layer>> layers;
  std::vector<std::unique_ptr<RigModel>> models;
  CurveFitOptions options;

  Study(unsigned seed, bool compliance_fitted, bool with_ball, bool rig_held_at_zero = false) {
    options.free = {{.parameter = modulus, .start = 1.5e5}};
    const Index presses = with_ball ? 2 : 1, count = 1 + presses + (compliance_fitted ? 1 : 0);
    Rig rig;
    rig.compliance = {rig_held_at_zero ? 0.0 : soft, {}};
    if (compliance_fitted) rig.compliance.place = count - 1;
    for (Index i = 0; i < presses; ++i) {
      curves.push_back(measured(i == 1, seed));
      layers.push_back(std::make_unique<Layer>(radius_of(i == 1), depths_for_rig(1.3 * deepest)));
      if (!rig_held_at_zero) {
        rig.touch_offset.place = 1 + i;
        options.free.push_back(
            {.parameter = touch_offset, .start = 0.0, .scale = deepest, .of = curves.back().name});
      }
      models.push_back(std::make_unique<RigModel>(*layers.back(), depths_for_rig(1.3 * deepest), 1,
                                                  rig, curves.back().x, std::vector<double>(),
                                                  rig_held_at_zero ? 1 : count));
    }
    if (compliance_fitted)
      options.free.push_back({.parameter = compliance, .start = 2e-5, .scale = 1e-3});
  }
  CurveFit fit() {
    std::vector<ForwardModel*> list;
    for (const auto& model : models) list.push_back(model.get());
    return fit_curves(curves, list, options);
  }
};

}  // namespace

TEST(RigStudy, WithTheComplianceKnownTheModulusIsWithinItsInterval) {
  int covered = 0;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const CurveFit fit = Study(seed, false, false).fit();
    ASSERT_TRUE(fit.converged);
    EXPECT_NEAR(fit.estimates(0), modulus_value, 0.02 * modulus_value) << seed;
    covered += fit.lower(0) <= modulus_value && modulus_value <= fit.upper(0);
  }
  EXPECT_GE(covered, 45);
}

TEST(RigStudy, AFittedComplianceIsNearlyCollinearWithTheModulus) {
  FitRecord record;
  Study study(1, true, false);
  record.fit = study.fit();
  record.curves = study.curves;
  record.conditions = {""};
  record.options = study.options;
  EXPECT_LT(std::abs(record.fit.estimates(0) / modulus_value - 1.0),
            (record.fit.upper(0) - record.fit.lower(0)) / modulus_value);
  const std::string said = fit_statement(record);
  EXPECT_NE(said.find("modulus and compliance are nearly collinear"), std::string::npos) << said;
  EXPECT_NE(said.find("rigid blank"), std::string::npos);
}

/// By how much a press on the ball narrows is told from the fit to the plane's press alone.
TEST(RigStudy, ASecondObstacleNarrowsAsItsGradientsTold) {
  const CurveFit first = Study(1, true, false).fit();
  Layer press(radius_of(true), depths_for_rig(1.3 * deepest));
  const Curve planned = measured(true, 0);
  RigModel model(press, depths_for_rig(1.3 * deepest), 1, {{0.0, 1}, {0.0, 2}, {}, {}}, planned.x,
                 {}, 3);
  VectorXd at(3);
  at << first.estimates(0), offset, first.estimates(2);
  const CurveSlopes slopes = model.evaluate(at);
  const VectorXd weight = (noise * slopes.value).cwiseInverse();
  MatrixXd rows = MatrixXd::Zero(points, 3);  // the first press's touch has nothing to do with it
  rows.col(0) = weight.cwiseProduct(slopes.jacobian.col(0));
  rows.col(2) = weight.cwiseProduct(slopes.jacobian.col(2));
  const VectorXd told =
      narrowing(first.covariance, rows, weight.cwiseProduct(slopes.jacobian.col(1)));
  const CurveFit both = Study(1, true, true).fit();
  const double found = both.standard_errors(0) / first.standard_errors(0);
  EXPECT_LT(found, 0.8);
  EXPECT_NEAR(told(0), found, 0.3 * found);
}

/// Far from its data first order misleads, and a zero of the force alone does as much as the touch
/// alone. Of pairs that are freed together only the true one explains all.
TEST(RigStudy, ARigHeldAtZeroIsExplainedByTouchAndCompliance) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Study study(seed, false, false, true);
    const CurveFit fit = study.fit();
    ASSERT_TRUE(fit.chi_square_probability);
    EXPECT_LT(*fit.chi_square_probability, 1e-3);
    const auto freed = [&](MaterialParameter first, MaterialParameter second) {
      CurveFitOptions options = study.options;
      Rig rig;
      for (const MaterialParameter each : {first, second}) {
        (each == touch_offset ? rig.touch_offset
         : each == compliance ? rig.compliance
                              : rig.force_offset)
            .place = Index(options.free.size());
        const double scale = each == touch_offset ? deepest : each == compliance ? 5e-4 : 10.0;
        options.free.push_back({.parameter = each, .start = 0.0, .scale = scale});
        if (each != compliance) continue;
        options.free.back().lower = -0.1 * scale;
        options.free.back().upper = 0.9 * scale;
      }
      RigModel model(*study.layers[0], depths_for_rig(1.3 * deepest), 1, rig, study.curves[0].x, {},
                     3);
      const CurveFit after = fit_curves(study.curves, {&model}, options);
      const ScoreTest both = score_test(fit, after, {});
      EXPECT_NEAR(both.decrease, *fit.chi_square - *after.chi_square, 1e-9 * *fit.chi_square);
      EXPECT_EQ(both.amount, after.estimates(2));
      return *after.chi_square_probability;
    };
    EXPECT_GT(freed(touch_offset, compliance), 1e-3);
    EXPECT_LT(freed(touch_offset, force_offset), 1e-3);
    EXPECT_LT(freed(compliance, force_offset), 1e-3);
  }
}

namespace {

/// One force over travel from before touch on, with noise that is the same for all forces: the
/// touch is where a curve that starts flat leaves zero.
struct FlatStart {
  std::vector<Curve> curves;
  Layer press{finger, depths_for_rig(1.3 * deepest)};
  std::unique_ptr<RigModel> model;
  CurveFitOptions options;

  FlatStart(unsigned seed, double sigma) {
    std::mt19937 random(seed);
    std::normal_distribution<double> deviate(0.0, sigma);
    Curve curve;
    curve.is_travel = true;
    for (int i = -10; i <= 12; ++i) {
      const double delta = 0.05 * deepest * i;
      curve.x.push_back(offset + delta);
      curve.y.push_back((delta > 0.0 ? modulus_value * layer(finger, delta) : 0.0) +
                        deviate(random));
      curve.sigma.push_back(sigma);
    }
    curves.push_back(curve);
    options.free = {{.parameter = modulus, .start = 1.5e5},
                    {.parameter = touch_offset, .start = 0.0, .scale = deepest}};
    Rig rig;
    rig.touch_offset.place = 1;
    model = std::make_unique<RigModel>(press, depths_for_rig(1.3 * deepest), 1, rig, curve.x,
                                       std::vector<double>(), 2);
  }
};

}  // namespace

/// The profile against chi-square itself: at every modulus the best touch by a scan of its own.
TEST(RigStudy, TheProfilesEndsAreWhereChiSquareHasRisen) {
  FlatStart study(3, 0.4);
  const CurveFit fit = fit_curves(study.curves, {study.model.get()}, study.options);
  const Curve& curve = study.curves[0];
  const auto chi_square = [&](double e, double touch) {
    double sum = 0.0;
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      const double delta = curve.x[i] - touch, force = delta > 0.0 ? e * layer(finger, delta) : 0.0;
      sum += std::pow((curve.y[i] - force) / curve.sigma[i], 2);
    }
    return sum;
  };
  const auto least = [&](double e) {
    double best = 1e300;
    for (int k = -4000; k <= 4000; ++k)
      best = std::min(best, chi_square(e, fit.estimates(1) + 2.5e-7 * k));
    return best;
  };
  const ProfileInterval interval =
      profile_interval(study.curves, {study.model.get()}, study.options, fit, 0, 1.96);
  const double level = chi_square(fit.estimates(0), fit.estimates(1)) + 1.96 * 1.96;
  EXPECT_NEAR(least(interval.lower), level, 0.02);
  EXPECT_NEAR(least(interval.upper), level, 0.02);
  // Skew: a stiffer rubber that is touched later meets the flat start as well.
  EXPECT_GT(interval.upper - fit.estimates(0), 1.1 * (fit.estimates(0) - interval.lower));
}

/// Where the linearised interval of the touch is off, the profile's covers the truth as often as it
/// says: 95 % of 200, within three deviations of that count.
TEST(RigStudy, TheProfilesIntervalsCoverTheTruth) {
  int modulus_covered = 0, touch_covered = 0;
  constexpr int trials = 200;
  for (unsigned seed = 1; seed <= trials; ++seed) {
    FlatStart study(seed, 0.4);
    const CurveFit fit = fit_curves(study.curves, {study.model.get()}, study.options);
    const auto covers = [&](std::size_t place, double truth) {
      const ProfileInterval own =
          profile_interval(study.curves, {study.model.get()}, study.options, fit, place, 1.96);
      return !(own.lower > truth) && !(own.upper < truth);
    };
    modulus_covered += covers(0, modulus_value);
    touch_covered += covers(1, offset);
  }
  const double slack = 3.0 * std::sqrt(trials * 0.95 * 0.05);
  EXPECT_NEAR(modulus_covered, 0.95 * trials, slack);
  EXPECT_NEAR(touch_covered, 0.95 * trials, slack);
}
