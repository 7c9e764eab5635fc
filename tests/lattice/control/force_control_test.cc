#include <gtest/gtest.h>

#include <numbers>

#include "lattice/control/force_controller.h"
#include "lattice/control/hybrid_controller.h"
#include "plants.h"

using namespace plants;
using lattice::ControlMode;
using lattice::ForceController;
using lattice::ForceSettings;
using lattice::HybridController;
using lattice::PidSettings;

namespace {

constexpr double k = 100.0;  // of Slider [N/m]

/// Force [N] of df/dt = g (f_d - f'), df'/dt = 8 w (f - f'), g = 7/8 w, from f = f' = f0.
double analytic(double time, double f0, double fd, double w) {
  return fd - (fd - f0) * (49.0 * std::exp(-w * time) - std::exp(-7.0 * w * time)) / 48.0;
}

}  // namespace

TEST(ForceController, StepResponseIsTheFirstOrderOneOnALinearSpring) {
  for (const double bandwidth : {2.0, 5.0}) {
    Slider slider;
    ForceSettings settings;
    settings.bandwidth = bandwidth;
    settings.stiffness = [](double) { return k; };
    const ControlTask task = task_for(slider, 1.0);  // too fast to be a limit
    slider.position = slider.clearance + 0.04 / k;
    ControlTask pressed = task;
    pressed.path = [&](double) {
      Target target;
      target.pose.position.z() = slider.clearance + 0.04 / k;
      return target;
    };
    ForceController controller(PidSettings{}, settings, pressed);
    controller.pid().start_from({Vector3(0.0, 0.0, 0.04), Vector3::Zero()});
    const double w = 2.0 * std::numbers::pi * bandwidth;
    double overshoot = 0.0, early = 0.0, late = 0.0;
    while (slider.time * w < 8.0) {
      // The servo follows about a third of its 1/w later, which is 1.6 % of the step per Hz.
      const double expected = analytic(slider.time, 0.04, 0.1, w);
      EXPECT_NEAR(slider.contact(), expected, 0.016 * bandwidth * 0.06) << slider.time;
      if (slider.time * w <= 1.0) early = slider.time * w + std::log(0.1 - slider.contact());
      if (slider.time * w <= 4.0) late = slider.time * w + std::log(0.1 - slider.contact());
      slider.cycle(controller, task.period);
      overshoot = std::max(overshoot, slider.contact() - 0.1);
    }
    EXPECT_NEAR(1.0 + (early - late) / 3.0, 1.0, 0.01) << bandwidth;  // rate of decay over w
    EXPECT_LT(overshoot, 0.01 * 0.1);
    EXPECT_NEAR(slider.contact(), 0.1, 1e-4);
  }
}

TEST(ForceController, FindsTheStiffnessItselfAndDoesNotOvershoot) {
  for (const double stiffness : {30.0, 100.0, 300.0}) {
    for (const double speed : {0.01, 0.05}) {
      Slider slider;
      slider.spring = [=](double depth) { return stiffness * depth; };
      const ControlTask task = task_for(slider, speed);
      ForceController controller(PidSettings{}, {}, task);
      double highest = 0.0;
      while (slider.time < 1.5) {
        slider.cycle(controller, task.period);
        highest = std::max(highest, slider.contact());
      }
      EXPECT_LT(highest, 1.05 * 0.1) << stiffness << ' ' << speed;
      EXPECT_NEAR(slider.contact(), 0.1, 1e-3) << stiffness << ' ' << speed;
      EXPECT_NEAR(controller.report().stiffness, stiffness, 0.2 * stiffness);
    }
  }
}

TEST(ForceController, ALimitedActuatorDoesNotWindItUp) {
  Slider slider;
  const ControlTask task = task_for(slider, 0.05);
  PidSettings weak;
  weak.force_limit = 0.06;  // cannot hold the force
  ForceController controller(weak, {}, task);
  while (slider.time < 1.0) slider.cycle(controller, task.period);
  EXPECT_NEAR(slider.contact(), 0.06, 0.006);
  // The spring becomes so soft that nothing is limited any more: no long way back.
  slider.retreat = 0.0;
  slider.spring = [](double depth) { return 120.0 * depth; };
  EXPECT_LT(slider.position, slider.clearance + 0.001);
}

TEST(HybridController, SwitchesOnceAndDoesNotOvershoot) {
  for (const double noise : {0.0, 5e-4}) {
    for (const double speed : {0.01, 0.05}) {
      Slider slider;
      slider.spring = [](double depth) { return 1300.0 * std::pow(depth, 1.5); };
      slider.sensor_noise = noise;
      const ControlTask task = task_for(slider, speed);
      HybridController controller(PidSettings{}, {}, task);
      double highest = 0.0;
      while (slider.time < 1.5) {
        slider.cycle(controller, task.period);
        highest = std::max(highest, slider.contact());
      }
      EXPECT_EQ(controller.switches(), 1) << noise << ' ' << speed;
      EXPECT_EQ(controller.mode(), ControlMode::force);
      EXPECT_LT(highest, 1.05 * 0.1) << noise << ' ' << speed;
      EXPECT_NEAR(slider.contact(), 0.1, 2e-3) << noise << ' ' << speed;
    }
  }
}

TEST(HybridController, HandsOverWithoutAJump) {
  Slider slider;
  const ControlTask task = task_for(slider, 0.01);
  HybridController controller(PidSettings{}, {}, task);
  double before = 0.0;
  while (controller.switches() == 0) {
    before = slider.applied;
    slider.cycle(controller, task.period);
  }
  // Within a period the contact's force itself rises by k v T.
  EXPECT_NEAR(slider.applied, before, 3.0 * k * 0.01 * 1e-3);
}

TEST(HybridController, ReturnsToTheApproachWhenContactIsLostAndFindsItAgain) {
  Slider slider;
  const ControlTask task = task_for(slider, 0.05);
  HybridController controller(PidSettings{}, {}, task);
  while (slider.time < 0.5) slider.cycle(controller, task.period);
  EXPECT_EQ(controller.switches(), 1);
  slider.retreat = 5e-3;
  while (slider.time < 0.53) slider.cycle(controller, task.period);
  EXPECT_EQ(controller.mode(), ControlMode::position);
  double highest = 0.0;
  while (slider.time < 1.5) {
    slider.cycle(controller, task.period);
    highest = std::max(highest, slider.contact());
  }
  EXPECT_EQ(controller.switches(), 3);
  EXPECT_EQ(controller.mode(), ControlMode::force);
  EXPECT_LT(highest, 1.05 * 0.1);
}

TEST(HybridController, NoiseAboutAThresholdDoesNotMakeItChatter) {
  // Contact that comes to rest between the thresholds, with noise as wide as their distance.
  Slider slider;
  slider.sensor_noise = 3e-3;
  ForceSettings settings;
  settings.force = 0.02;
  settings.touch_force = 0.012;
  settings.release_force = 0.006;
  const ControlTask task = task_for(slider, 0.01);
  HybridController controller(PidSettings{}, settings, task);
  while (slider.time < 2.0) slider.cycle(controller, task.period);
  EXPECT_EQ(controller.switches(), 1);
}

TEST(ForceSettings, NameEveryBrokenRule) {
  ForceSettings settings;
  settings.force = -1.0;
  settings.bandwidth = 0.0;
  settings.release_force = 0.5;
  settings.dwell = -1.0;
  EXPECT_EQ(settings.violations().size(), 5u);
  settings = {};
  settings.bandwidth = 20.0;
  EXPECT_THROW(lattice::check(settings, PidSettings{}), meshes::InvalidInput);
}
