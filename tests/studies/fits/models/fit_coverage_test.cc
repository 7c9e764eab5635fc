/// 95 % intervals of presses behind a machine contain the truth in 95 % of experiments.
#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <functional>
#include <random>

#include "calibration/press_fit/rig_model.h"
#include "studies/config/loader.h"
#include "studies/fits/models/fit_input.h"
#include "studies/fits/models/fit_relaxation.h"
#include "studies/fits/models/fit_repeats.h"
#include "studies/fits/models/fit_rig.h"
#include "studies/fits/models/travel.h"

using namespace fingertip;
using namespace fingertip::studies;
using calibration::Curve;
using calibration::CurveSlopes;
using calibration::MaterialParameter;
using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr double truth = 2e5, reach = 3e-3;

/// Hertz: F = E 0.16 m² (delta/m)^1.5.
double hertz(double modulus, double delta) {
  return delta > 0.0 ? modulus * 0.16 * std::pow(delta, 1.5) : 0.0;
}
const double largest = hertz(truth, reach);

class HertzPress final : public calibration::ForwardModel {
 public:
  explicit HertzPress(std::vector<double> depths) : depths_(std::move(depths)) {}
  CurveSlopes evaluate(const VectorXd& parameters) override {
    CurveSlopes result{VectorXd(Index(depths_.size())), {}};
    for (std::size_t i = 0; i < depths_.size(); ++i)
      result.value(Index(i)) = hertz(parameters(0), depths_[i]);
    result.jacobian = result.value / parameters(0);
    return result;
  }

 private:
  std::vector<double> depths_;
};

/// One experiment: its curves, and the true values of all that is fitted, in that order.
struct Experiment {
  std::vector<Curve> curves;
  std::vector<double> truths;
};

/// A machine of which all is told but the touch.
CalibrationSettings known_machine() {
  CalibrationSettings settings;
  RigSettings& rig = settings.rig;
  rig.compliance = rig.force_offset = rig.drift = {.given = true};
  return settings;
}

/// How the fit of an experiment is asked for.
struct Order {
  CalibrationSettings settings = known_machine();
  std::size_t branches = 0;  ///< of a relaxation, sought
  bool profile = true;       ///< as of calibration.intervals = "auto"
};

/// The fit as calibrate does it of a press that is known, beginning at three quarters of the truth.
calibration::CurveFit fitted(const std::vector<Curve>& curves, const Order& order) {
  FitInput input;
  input.problem = CalibrationProblem::experiment;
  input.curves.assign(curves.begin(), curves.end());
  input.options.tolerance = 1e-2;
  input.options.free = {{.parameter = MaterialParameter::modulus, .start = 0.75 * truth}};
  input.profile_intervals = order.profile;
  for (FitCurve& curve : input.curves) curve.travel = travel_of(curve, order.settings);
  free_rigs(input);
  for (std::size_t k = 0; k < order.branches; ++k) {
    const Index at = Index(input.options.free.size());
    input.options.free.push_back({.parameter = calibration::relaxation_parameters[2 * k]});
    input.options.free.push_back({.parameter = calibration::relaxation_parameters[2 * k + 1]});
    input.branches.push_back({{0.0, at}, {0.0, at + 1}});
  }
  start_branches(load_config({}), input);
  add_starts_in_time(input);
  share_depths(input);
  std::deque<HertzPress> presses;
  std::deque<calibration::RigModel> models;
  std::vector<calibration::ForwardModel*> list;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const Travel& travel = *input.curves[i].travel;
    presses.emplace_back(travel.depths);
    list.push_back(&models.emplace_back(presses.back(), travel.depths, 1, travel.rig, curves[i].x,
                                        curves[i].time, Index(input.options.free.size()),
                                        input.branches));
  }
  calibration::FitRecord record;
  record.curves = curves;
  record.fit = calibration::fit_curves(curves, list, input.options);
  add_errors_and_intervals(input, list, record);
  EXPECT_TRUE(record.fit.converged);
  return record.fit;
}

/// Of so many seeds the share in which the interval of each parameter holds the truth.
std::vector<double> coverage(int seeds, const std::function<Experiment(std::mt19937&)>& measure,
                             const Order& order) {
  std::vector<double> held;
  for (int seed = 1; seed <= seeds; ++seed) {
    std::mt19937 random{unsigned(seed)};
    const Experiment experiment = measure(random);
    const calibration::CurveFit fit = fitted(experiment.curves, order);
    held.resize(experiment.truths.size());
    for (std::size_t k = 0; k < held.size(); ++k)
      if (fit.lower(Index(k)) <= experiment.truths[k] &&
          experiment.truths[k] <= fit.upper(Index(k)))
        held[k] += 1.0;
  }
  for (double& each : held) each /= seeds;
  return held;
}

/// A count of 120 has a deviation of 2 %.
constexpr int seeds = 120;

/// 95 % or more: what a model may miss unseen widens intervals also where it misses nothing.
void expect_honest(const std::vector<double>& held, const std::string& what, double least = 0.915) {
  for (std::size_t k = 0; k < held.size(); ++k)
    EXPECT_GE(held[k], least) << what << ", parameter " << k;
}

using Normal = std::normal_distribution<double>;
using Uniform = std::uniform_real_distribution<double>;

}  // namespace

/// Repeats drawn from a population of factors, each with a touch of its own: what is told is the
/// modulus of the population's mean, and Student's t of four repeats makes 3.2 deviations of it.
/// From a scatter as small as what noise makes of a factor, 1 %, which is not always seen, on.
TEST(FitCoverage, RepeatsTellTheMeanOfWhatTheyAreDrawnFrom) {
  const auto measure = [](double between, bool sigma, std::mt19937& random) {
    Normal normal;
    Uniform touches(0.1e-3, 0.6e-3);
    Experiment result{{}, {truth}};
    for (int k = 0; k < 4; ++k) {
      Curve& curve = result.curves.emplace_back();
      curve.name = std::to_string(k);
      curve.is_travel = true;
      const double touch = touches(random), factor = 1.0 + between * normal(random);
      for (int i = 0; i <= 40; ++i) {
        curve.x.push_back(3.6e-3 * i / 40);
        curve.y.push_back(factor * hertz(truth, curve.x.back() - touch) +
                          0.01 * largest * normal(random));
        if (sigma) curve.sigma.push_back(0.01 * largest);
      }
    }
    return result;
  };
  for (const auto& [between, sigma] : {std::pair(0.01, false), {0.2, false}, {0.2, true}})
    expect_honest(coverage(80, [&](std::mt19937& r) { return measure(between, sigma, r); },
                           {known_machine(), 0, false}),
                  std::to_string(between) + (sigma ? ", sigma" : ""), 0.9);
}

namespace {

/// A press of one minute whose zero is off and drifts, if `drifts`, and whose noise, 1 % of the
/// largest force, follows itself with the correlation r.
Experiment press_in_time(bool drifts, double r, std::mt19937& random) {
  constexpr int rows = 150;
  Normal normal;
  Uniform touches(0.3e-3, 0.6e-3);
  Experiment result;
  Curve& curve = result.curves.emplace_back();
  curve.is_travel = true;
  const double touch = touches(random), zero = drifts ? 0.1 * largest * normal(random) : 0.0,
               drift = drifts ? 0.002 * largest * normal(random) : 0.0;
  double error = normal(random);
  for (int i = 0; i <= rows; ++i) {
    curve.x.push_back(3.5e-3 * i / rows);
    curve.time.push_back(60.0 * i / rows);
    curve.y.push_back(zero + drift * curve.time.back() + hertz(truth, curve.x.back() - touch) +
                      0.01 * largest * error);
    error = r * error + std::sqrt(1.0 - r * r) * normal(random);
  }
  result.truths = {truth, touch};
  if (drifts) result.truths.insert(result.truths.end(), {zero, drift});
  return result;
}

}  // namespace

TEST(FitCoverage, AZeroThatDriftsIsTold) {
  Order order;
  order.settings.rig.force_offset = order.settings.rig.drift = {.fitted = true, .given = true};
  expect_honest(coverage(
                    seeds, [](std::mt19937& r) { return press_in_time(true, 0.0, r); }, order),
                "drift");
}

/// A zero that wanders is no drift: errors follow each other, and 150 values are worth 80 and 38.
TEST(FitCoverage, AZeroThatWandersWidensTheIntervals) {
  for (const double r : {0.0, 0.3, 0.6})
    expect_honest(
        coverage(seeds, [&](std::mt19937& random) { return press_in_time(false, r, random); }, {}),
        std::to_string(r));
}

/// Files that begin before touch, with a few rows of nothing, and under load.
TEST(FitCoverage, TouchAndModulusAreToldTogether) {
  for (const double begin : {-0.4e-3, 0.05e-3, 0.3e-3})
    for (const bool sigma : {false, true})
      expect_honest(coverage(seeds,
                             [&](std::mt19937& random) {
                               constexpr int rows = 34;
                               Normal normal;
                               const double touch = Uniform(0.3e-3, 0.4e-3)(random);
                               Experiment result{{{}}, {truth, touch}};
                               Curve& curve = result.curves.front();
                               curve.is_travel = true;
                               for (int i = 0; i <= rows; ++i) {
                                 curve.x.push_back(touch + begin + (reach - begin) * i / rows);
                                 curve.y.push_back(hertz(truth, curve.x.back() - touch) +
                                                   0.01 * largest * normal(random));
                                 if (sigma) curve.sigma.push_back(0.01 * largest);
                               }
                               return result;
                             },
                             {}),
                    std::to_string(begin) + (sigma ? ", sigma" : ""));
}

/// Rows before touch, and a zero of force that is sought: what is left of their forces is
/// round-off.
TEST(FitCoverage, RoundOffStaysRoundOff) {
  constexpr int rows = 40;
  Order order;
  order.settings.rig.force_offset = {.fitted = true, .given = true};
  for (unsigned seed = 1; seed <= 12; ++seed) {
    std::mt19937 random{seed};
    Normal normal;
    Curve curve;
    curve.is_travel = true;
    for (int i = 0; i < rows; ++i) {
      curve.x.push_back(1.4 * reach * i / rows);
      curve.y.push_back(hertz(truth, curve.x.back() - 0.4 * reach) + 0.003 * largest +
                        0.005 * largest * normal(random));
    }
    const calibration::CurveFit fit = fitted({curve}, order);
    for (double& force : curve.y) force *= 1.0 + 1e-10;
    const calibration::CurveFit same = fitted({curve}, order);
    for (Index k = 0; k < fit.estimates.size(); ++k) {
      const double error = fit.standard_errors(k);
      EXPECT_NEAR(same.estimates(k), fit.estimates(k), 1e-5 * error) << seed << ", " << k;
      EXPECT_NEAR(same.standard_errors(k), error, 1e-5 * error) << seed << ", " << k;
      EXPECT_NEAR(same.lower(k), fit.lower(k), 1e-3 * error) << seed << ", " << k;
      EXPECT_NEAR(same.upper(k), fit.upper(k), 1e-3 * error) << seed << ", " << k;
    }
  }
}

namespace {

/// Share and time of the branch; a ramp of 2 s, then a hold [s].
struct Hold {
  double share = 0.4, time = 4.0, lasts = 10.0;
};

/// Lee and Radok's integral over a ramp of constant speed by the midpoint rule: modulus after long
/// times, b = g/(1 - g).
double relaxing_force(const Hold& hold, double t) {
  constexpr int steps = 2000;
  constexpr double ramp = 2.0, speed = reach / ramp;
  const double end = std::min(t, ramp);
  double fading = 0.0;
  for (int k = 0; k < steps; ++k)
    fading += std::exp(-(t - end * (k + 0.5) / steps) / hold.time) *
              (hertz(truth, speed * end * (k + 1) / steps) - hertz(truth, speed * end * k / steps));
  return hertz(truth, speed * end) + hold.share / (1.0 - hold.share) * fading;
}

}  // namespace

/// What of a rubber relaxes, from a ramp and a hold. Where both touch and branch are sought the
/// search from a time of a tenth of the truth ended at a share of 0.95.
TEST(FitCoverage, AHoldTellsWhatRelaxes) {
  for (const bool touch_fitted : {false, true}) {
    const Hold hold = touch_fitted ? Hold{0.4, 4.0, 10.0} : Hold{0.3, 1.0, 40.0};
    Curve pressed;
    pressed.is_travel = pressed.in_time = true;
    for (int i = 0; i <= 60; ++i) {
      pressed.time.push_back(i <= 20 ? 0.1 * i : 2.0 + hold.lasts * (i - 20) / 40);
      pressed.x.push_back(reach * std::min(1.0, pressed.time.back() / 2.0));
      pressed.y.push_back(relaxing_force(hold, pressed.time.back()));
    }
    Order order{known_machine(), 1};
    order.settings.rig.touch_offset.fitted = touch_fitted;
    const auto measure = [&](std::mt19937& random) {
      Normal normal;
      Experiment result{{pressed}, {truth}};
      Curve& curve = result.curves.front();
      for (double& y : curve.y) y += 0.005 * largest * normal(random);
      curve.course.relaxation = 1.0 - curve.y.back() / curve.y[20];
      if (touch_fitted) result.truths.push_back(0.0);
      result.truths.insert(result.truths.end(), {hold.share, hold.time});
      return result;
    };
    expect_honest(coverage(seeds, measure, order),
                  std::to_string(hold.time) + (touch_fitted ? " s, touch" : " s"));
  }
}
