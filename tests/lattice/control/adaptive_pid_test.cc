#include "lattice/control/adaptive_pid.h"

#include <gtest/gtest.h>

#include <complex>
#include <numbers>

#include "plants.h"

using namespace plants;
using lattice::AdaptivePid;
using lattice::AdaptiveSettings;
using lattice::PidSettings;
using lattice::RelayResult;
using lattice::StiffnessEstimator;

namespace {

RelayResult relay_on(const Slider& slider) {
  return lattice::relay_experiment(with_identification(task_for(slider, 0.01), slider), 1.0)
      .value();
}

PidSettings feedback_only() {
  PidSettings settings;
  settings.bond_compensation = 0.0;
  return settings;
}

/// Largest deviation from the commanded speed, relative, between two times.
double speed_error(AdaptivePid& controller, Slider slider, const ControlTask& task, double from,
                   double until) {
  double worst = 0.0;
  while (slider.time < until) {
    slider.cycle(controller, task.period);
    if (slider.time < from) continue;
    const double wanted = task.path(slider.time).twist.velocity.z();
    worst = std::max(worst, std::abs(slider.velocity - wanted) / wanted);
  }
  return worst;
}

}  // namespace

TEST(Relay, FindsMassAndDelayOfAnIntegrator) {
  // The hold acts T/2 late on average; whole periods of latency add.
  for (const int latency : {0, 1, 2, 5}) {
    Slider slider;
    slider.latency = latency;
    const RelayResult found = relay_on(slider);
    EXPECT_NEAR(found.mass, slider.mass, 1e-6 * slider.mass) << latency;
    EXPECT_NEAR(found.delay, (latency + 0.5) * 1e-3, 1e-8) << latency;
    EXPECT_NEAR(found.ultimate_period, 4.0 * found.delay, 1e-8) << latency;
    // The triangle's height is 2 d L/M: Ku = 8 d/(pi H).
    EXPECT_NEAR(found.ultimate_gain, 4.0 * slider.mass / (std::numbers::pi * found.delay),
                1e-3 * found.ultimate_gain);
  }
}

TEST(Relay, IsNotDeceivedByAConstantLoad) {
  Slider slider;
  slider.latency = 3;
  slider.load = 0.006;
  const RelayResult found = relay_on(slider);
  EXPECT_NEAR(found.mass, slider.mass, 0.05 * slider.mass);
  EXPECT_NEAR(found.delay, 3.5e-3, 0.3e-3);
  slider.latency = 0;
  slider.load = 0.1;  // more than the relay starts with
  const RelayResult heavy = relay_on(slider);
  EXPECT_GT(heavy.level, 0.1);
  EXPECT_NEAR(heavy.mass, slider.mass, 0.1 * slider.mass);
}

TEST(Relay, ListensToTheNoiseFirst) {
  Slider slider;
  slider.latency = 2;
  slider.velocity_noise = 2e-4;
  const RelayResult found = relay_on(slider);
  EXPECT_GT(found.hysteresis, 2e-4);
  EXPECT_NEAR(found.mass, slider.mass, 0.15 * slider.mass);
  EXPECT_NEAR(found.delay, 2.5e-3, 0.6e-3);
}

TEST(Relay, TheRuleLeavesTheSensitivityItPromises) {
  for (const double wanted : {1.4, 2.0}) {
    const double angle = lattice::tuned_delay_angle(wanted);
    double peak = 0.0, nearest = 1e300;
    for (double y = 0.01; y < 50.0; y *= 1.001) {
      const std::complex<double> s(0.0, y);
      const auto loop = (3.0 * s * s + 3.0 * s + 1.0) / (s * s * s) * std::exp(-angle * s);
      peak = std::max(peak, 1.0 / std::abs(1.0 + loop));
      nearest = std::min(nearest, std::abs(1.0 + loop));
    }
    EXPECT_NEAR(peak, wanted, 1e-3);
  }
  EXPECT_NEAR(lattice::tuned_delay_angle(2.0), 0.195, 0.001);
}

TEST(Estimator, FindsASpringAndADamper) {
  StiffnessEstimator estimator({}, 1e-3);
  double v = 0.01;
  for (int i = 1; i < 100; ++i) {
    const double faster = 0.01 + 0.004 * std::sin(0.3 * i), dx = 1e-3 * 0.5 * (v + faster);
    estimator.update(dx, faster - v, 120.0 * dx + 0.3 * (faster - v));
    v = faster;
  }
  EXPECT_NEAR(estimator.stiffness(), 120.0, 0.1);
  EXPECT_NEAR(estimator.damping(), 0.3, 0.001);
}

TEST(Estimator, KeepsItsSafeguards) {
  lattice::EstimatorLimits limits;
  StiffnessEstimator estimator(limits, 1e-3);
  const auto before = estimator.covariance();
  EXPECT_FALSE(estimator.update(1e-9, 0.0, 1e-6));  // no excitation
  EXPECT_EQ(estimator.covariance(), before);
  for (int i = 0; i < 5000; ++i) estimator.update(1e-5, 0.0, 1e-3);
  EXPECT_NEAR(estimator.stiffness(), 100.0, 1e-6);
  EXPECT_LE(estimator.covariance().trace(), 2.0 * std::pow(limits.spread, 2) * (1 + 1e-12));
  EXPECT_GT(estimator.covariance().determinant(), 0.0);
  for (int i = 0; i < 100; ++i) estimator.update(1e-5, 0.0, 1.0);
  EXPECT_EQ(estimator.stiffness(), limits.stiffness);  // projected
  for (int i = 0; i < 100; ++i) estimator.update(1e-5, 0.0, -1.0, 50.0);
  EXPECT_EQ(estimator.stiffness(50.0), 0.0);
  EXPECT_FALSE(estimator.update(std::nan(""), 0.0, 1.0));  // starts afresh
  EXPECT_EQ(estimator.stiffness(70.0), 70.0);
  EXPECT_FALSE(estimator.update(1e-5, INFINITY, 1.0));
  EXPECT_EQ(estimator.stiffness(), 0.0);
}

TEST(AdaptivePid, TunesItselfToTheLatency) {
  for (const int latency : {0, 2}) {
    Slider slider;
    slider.latency = latency;
    slider.clearance = 5e-3;
    const ControlTask task = with_identification(task_for(slider, 0.01), slider);
    AdaptivePid controller(feedback_only(), {}, task);
    const double omega = lattice::tuned_delay_angle(2.0) / ((latency + 0.5) * 1e-3);
    EXPECT_NEAR(controller.natural_frequency(), omega / (2.0 * std::numbers::pi), 1e-3 * omega);
    EXPECT_LT(speed_error(controller, slider, task, 0.3, 0.5), 0.002) << latency;
  }
}

TEST(AdaptivePid, LearnsTheStiffnessWithoutMeasuringForce) {
  for (const int latency : {0, 2}) {
    Slider slider;
    slider.latency = latency;
    slider.spring = [](double depth) { return 150.0 * depth; };
    const ControlTask task = with_identification(task_for(slider, 0.01), slider);
    AdaptivePid controller(feedback_only(), {}, task);
    while (slider.time < 0.25) slider.cycle(controller, task.period);
    EXPECT_NEAR(controller.stiffness(), 150.0, 0.02 * 150.0) << latency;
  }
}

TEST(AdaptivePid, ScheduleAndEstimateKeepTheSpeedThroughAStiffeningContact) {
  // F = K d^(3/2): through feedback alone the speed lags.
  Slider slider;
  const double K = 1300.0;
  slider.spring = [K](double depth) { return K * std::pow(depth, 1.5); };
  const ControlTask task = with_identification(task_for(slider, 0.05), slider);
  const double touch =
      meshes::PressMotion({.speed = 0.05, .clearance = slider.clearance}).touch_time();
  const auto error = [&](bool scheduled, bool estimated) {
    AdaptiveSettings settings;
    settings.estimate = estimated;
    if (scheduled) settings.stiffness = [K](double d) { return 1.5 * K * std::sqrt(d); };
    AdaptivePid controller(feedback_only(), settings, task);
    return speed_error(controller, slider, task, touch, touch + 0.06);
  };
  const double plain = error(false, false), scheduled = error(true, false),
               estimated = error(false, true), both = error(true, true);
  EXPECT_GT(plain, 0.004);
  EXPECT_LT(scheduled, 0.2 * plain);
  EXPECT_LT(estimated, plain);
  EXPECT_LT(both, 0.2 * plain);
  std::printf("plain %.4f scheduled %.4f estimated %.4f both %.4f\n", plain, scheduled, estimated,
              both);
}

TEST(AdaptivePid, DoesNotNeedToBeToldTheMass) {
  Slider slider;
  slider.clearance = 5e-3;
  ControlTask task = task_for(slider, 0.01);
  task.inertia *= 0.5;
  const ControlTask deceived = with_identification(task, slider);
  AdaptivePid controller(feedback_only(), {}, deceived);
  EXPECT_NEAR(controller.relay()->mass, slider.mass, 1e-6);
  EXPECT_LT(speed_error(controller, slider, deceived, 0.06, 0.4), 2e-3);
}
