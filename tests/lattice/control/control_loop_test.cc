#include "lattice/control/control_loop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "meshes/press/press_motion.h"
#include "tests/lattice/finger_scenes.h"

using namespace fingertip;
using namespace fixtures;
using lattice::Command;
using lattice::ControlLoop;
using lattice::HardwareSettings;
using lattice::Measurement;
using lattice::PidSettings;
using lattice::Target;
using lattice::VirtualFinger;
using lattice::Wrench;

namespace {

constexpr double period = 1e-3;

/// Answers what a test says and remembers what it saw.
class Scripted final : public lattice::Controller {
 public:
  using Law = std::function<Command(const Measurement& measurement, int cycle)>;
  explicit Scripted(Law law) : law_(std::move(law)) {}
  Command command(const Measurement& measurement) override {
    seen.push_back(measurement);
    return law_(measurement, int(seen.size()) - 1);
  }
  void reset() override { seen.clear(); }
  std::vector<Measurement> seen;

 private:
  Law law_;
};

Wrench push(double force) {
  return {Vector3(0.0, 0.0, force), Vector3::Zero()};
}

void run(ControlLoop& loop, int cycles) {
  for (int i = 0; i < cycles; ++i) {
    loop.sample();
    loop.advance();
  }
}

/// The way of a press from the finger's start [m, m/s].
std::function<Target(double)> way(const VirtualFinger& finger, double speed, double clearance) {
  const Vector3 start = finger.rod_body().endpoint;
  return [start,
          approach = meshes::PressMotion({.speed = speed, .clearance = clearance})](double time) {
    const meshes::SetPoint at = approach.at(time);
    Target target;
    target.pose.position = start + at.distance * Vector3::UnitZ();
    target.twist.velocity = at.speed * Vector3::UnitZ();
    target.acceleration.velocity = at.acceleration * Vector3::UnitZ();
    return target;
  };
}

}  // namespace

// Far from the plane the momentum of the whole finger is the integral of the force that acts.

TEST(ControlLoop, HoldsACommandUntilTheNext) {
  VirtualFinger finger(coarse_finger(1.0));
  Scripted controller([](const Measurement&, int cycle) { return push(0.1 * (cycle % 3) - 0.05); });
  ControlLoop loop(finger, controller, {}, {}, period);
  double impulse = 0.0;
  for (int cycle = 0; cycle < 10; ++cycle) {
    run(loop, 1);
    impulse += period * (0.1 * (cycle % 3) - 0.05);
    EXPECT_NEAR(finger.time(), period * (cycle + 1), 1e-12);
    EXPECT_NEAR(momentum(finger).z(), impulse, 1e-12);
  }
}

TEST(ControlLoop, ACommandActsExactlyAfterTheActuatorsLatency) {
  for (const double latency : {0.37e-3, 1e-3, 2.6e-3}) {
    VirtualFinger finger(coarse_finger(1.0));
    Scripted controller([](const Measurement&, int cycle) { return push(cycle >= 3 ? 0.2 : 0.0); });
    HardwareSettings hardware;
    hardware.actuator_latency = latency;
    ControlLoop loop(finger, controller, hardware, {}, period);
    for (int cycle = 0; cycle < 8; ++cycle) {
      run(loop, 1);
      const double acted = std::max(0.0, period * (cycle + 1) - (3 * period + latency));
      EXPECT_NEAR(momentum(finger).z(), 0.2 * acted, 1e-12) << latency << " s, cycle " << cycle;
    }
  }
}

TEST(ControlLoop, MeasurementsAreAsOldAsTheSensorsLatency) {
  for (const double latency : {0.0, 0.4e-3, 1e-3, 2.5e-3}) {
    VirtualFinger finger(coarse_finger(1.0));
    Scripted controller([](const Measurement&, int) { return push(0.1); });
    HardwareSettings hardware;
    hardware.sensor_latency = latency;
    ControlLoop loop(finger, controller, hardware, {}, period);
    run(loop, 10);
    for (int cycle = 0; cycle < 10; ++cycle) {
      const double taken = std::max(0.0, cycle * period - latency);
      EXPECT_NEAR(controller.seen[std::size_t(cycle)].time, taken, 1e-11) << latency;
    }
  }
}

TEST(ControlLoop, ActuatorsThatAreSlowRampTheForce) {
  VirtualFinger finger(coarse_finger(1.0));
  Scripted controller([](const Measurement&, int) { return push(1.0); });
  HardwareSettings hardware;
  hardware.force_rate = 50.0;
  ControlLoop loop(finger, controller, hardware, {}, period);
  double impulse = 0.0;
  for (int cycle = 0; cycle < 5; ++cycle) {
    run(loop, 1);
    impulse += period * 0.05 * (cycle + 1);
    EXPECT_EQ(loop.commanded().force.z(), 1.0);
    EXPECT_NEAR(loop.applied().force.z(), 0.05 * (cycle + 1), 1e-15);
    EXPECT_NEAR(momentum(finger).z(), impulse, 1e-12);
  }
}

TEST(ControlLoop, WhatIsNoNumberEndsTheRun) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect_failure = [](const Command& command) {
    VirtualFinger finger(coarse_finger(1.0));
    Scripted controller([&](const Measurement&, int) { return command; });
    ControlLoop loop(finger, controller, {}, {}, period);
    EXPECT_THROW(loop.sample(), lattice::ControllerFailed);
  };
  expect_failure(push(nan));
  expect_failure(push(-std::numeric_limits<double>::infinity()));
  Target target;
  target.acceleration.angular_velocity.y() = nan;
  expect_failure(target);
  target = {};
  target.pose.orientation.x() = nan;
  expect_failure(target);
}

TEST(ControlLoop, ASetPointGoesThroughThePidOfTheServo) {
  VirtualFinger with_servo(coarse_finger(0.2e-3)), with_pid(coarse_finger(0.2e-3));
  const PidSettings settings;
  const auto target = way(with_servo, 0.02, 0.2e-3);
  Scripted set_points([&](const Measurement& m, int) { return target(m.time); });
  lattice::PidController pid(settings, with_pid.rod_body().inertia_at_endpoint(), target);
  ControlLoop by_servo(with_servo, set_points, {}, settings, period);
  ControlLoop by_pid(with_pid, pid, {}, settings, period);
  for (int cycle = 0; cycle < 40; ++cycle) {
    run(by_servo, 1);
    run(by_pid, 1);
    EXPECT_EQ(by_servo.commanded().force, by_pid.commanded().force);
    EXPECT_EQ(by_servo.commanded().torque, by_pid.commanded().torque);
  }
  EXPECT_GT(with_servo.finger().touching(), 0);
  EXPECT_TRUE(same_bits(with_servo, with_pid));
}

TEST(ControlLoop, ResetMakesTheSameRunAgain) {
  VirtualFinger finger(coarse_finger(0.2e-3)), fresh(coarse_finger(0.2e-3));
  const auto target = way(finger, 0.02, 0.2e-3);
  HardwareSettings hardware;
  hardware.position.noise = 1e-7;
  hardware.force.noise = 1e-4;
  hardware.force.resolution = 1e-3;
  hardware.sensor_latency = 0.4e-3;
  hardware.actuator_latency = 1.3e-3;
  hardware.force_rate = 500.0;
  PidSettings slow;  // so that it bears the latencies
  slow.natural_frequency = 20.0;
  const auto law = [&](const Measurement& m, int) { return target(m.time); };
  Scripted controller(law), untouched(law);
  ControlLoop loop(finger, controller, hardware, slow, period);
  ControlLoop again(fresh, untouched, hardware, slow, period);
  run(loop, 25);  // into contact
  EXPECT_GT(finger.finger().touching(), 0);
  loop.reset();
  EXPECT_EQ(finger.time(), 0.0);
  run(loop, 40);
  run(again, 40);
  ASSERT_EQ(controller.seen.size(), untouched.seen.size());
  for (std::size_t i = 0; i < untouched.seen.size(); ++i) {
    EXPECT_EQ(controller.seen[i].pose.position, untouched.seen[i].pose.position) << i;
    EXPECT_EQ(controller.seen[i].wrench.force, untouched.seen[i].wrench.force) << i;
  }
  EXPECT_TRUE(same_bits(finger, fresh));
}
