#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "lattice/control/pid.h"

using namespace fingertip;
using lattice::Measurement;
using lattice::Pid;
using lattice::PidSettings;
using lattice::RodState;
using lattice::Target;
using lattice::Wrench;
using meshes::Vector3;

namespace {

Measurement measure(const RodState& rod, double time, const Wrench& bond = {}) {
  Measurement m;
  m.time = time;
  m.pose = {rod.endpoint(), rod.pose().orientation};
  m.twist = {rod.velocity_at(rod.endpoint()), rod.angular_velocity()};
  m.wrench = bond;
  return m;
}

/// A controlled rod without a tip, disturbed by a wrench at its endpoint that the controller does
/// not see.
struct ControlledRod {
  RodState rod{lattice::rod_body({}, {})};
  Pid pid;
  Target target;
  double time = 0.0, next = 0.0;
  Wrench command;

  ControlledRod(const PidSettings& settings, const Vector3& shift)
      : pid(settings, rod.body().inertia_at_endpoint()) {
    target.pose.position = rod.body().endpoint + shift;
  }

  void run(double duration, const Wrench& disturbance, double dt = 1e-6) {
    for (const double end = time + duration; time < end - 0.5 * dt; time += dt) {
      if (time >= next - 0.5 * dt) {
        command = pid.follow(measure(rod, time), target);
        next += pid.settings().period;
      }
      rod.kick({command.force + disturbance.force, command.torque + disturbance.torque},
               rod.endpoint(), dt);
      rod.drift(dt);
    }
  }
  double error() const { return (rod.endpoint() - rod.body().endpoint).z(); }
};

PidSettings fast_sampling() {
  PidSettings settings;
  settings.period = 1e-5;
  settings.natural_frequency = 20.0;
  settings.derivative_filter = 1e6;
  settings.bond_compensation = 0.0;
  return settings;
}

}  // namespace

TEST(Pid, AnswersAForceStepLikeATriplePole) {
  // M x'' = F - M(3 w² x + w³ ∫x + 3 w x') from rest: x = F/(2M) t² exp(-w t).
  ControlledRod loop(fast_sampling(), Vector3::Zero());
  const double force = 0.05, w = 2.0 * std::numbers::pi * 20.0;
  for (const double t : {0.005, 0.015, 0.03, 0.06}) {
    loop.run(t - loop.time, {Vector3(0.0, 0.0, force), Vector3::Zero()});
    const double exact = force / (2.0 * loop.rod.body().mass) * t * t * std::exp(-w * t);
    const double peak = force / (2.0 * loop.rod.body().mass) * 4.0 / (w * w) * std::exp(-2.0);
    EXPECT_NEAR(loop.error(), exact, 0.01 * peak) << t;
  }
}

TEST(Pid, RemovesAConstantTorqueCompletely) {
  ControlledRod loop(fast_sampling(), Vector3::Zero());
  const Wrench disturbance{Vector3(0.02, 0.0, 0.0), Vector3(0.0, 2e-4, 1e-4)};
  loop.run(0.25, disturbance, 1e-5);
  EXPECT_LT(Eigen::AngleAxisd(loop.rod.pose().orientation).angle(), 1e-6);
  EXPECT_LT((loop.rod.endpoint() - loop.rod.body().endpoint).norm(), 1e-8);
  EXPECT_LT((loop.command.force + disturbance.force).norm(), 1e-5);
  EXPECT_LT((loop.command.torque + disturbance.torque).norm(), 1e-6);
}

TEST(Pid, ObeysItsLimitsAndUnwinds) {
  // A set point far beyond what the actuator can reach quickly: the integrator must not wind up.
  PidSettings settings = fast_sampling();
  settings.force_limit = 0.01;
  ControlledRod loop(settings, Vector3(0.0, 0.0, 5e-3));
  double overshoot = 0.0;
  bool was_saturated = false;
  while (loop.time < 0.6) {
    loop.run(1e-3, {}, 1e-5);
    was_saturated = was_saturated || loop.pid.saturated();
    EXPECT_LE(loop.command.force.norm(), 0.01 * (1.0 + 1e-12));
    overshoot = std::max(overshoot, loop.error() - 5e-3);
  }
  EXPECT_TRUE(was_saturated);
  EXPECT_LT(overshoot, 5e-3);  // a wound-up integrator runs far past the target
  EXPECT_NEAR(loop.error(), 5e-3, 1e-5);
}

TEST(Pid, FeedsTheMeasuredBondWrenchForward) {
  PidSettings settings;
  settings.bond_compensation = 0.5;
  const RodState rod(lattice::rod_body({}, {}));
  Pid pid(settings, rod.body().inertia_at_endpoint());
  Target target;
  target.pose.position = rod.endpoint();
  const Wrench answer =
      pid.follow(measure(rod, 0.0, {Vector3(0.1, 0.2, -0.3), Vector3(0.01, 0.0, -0.02)}), target);
  EXPECT_LT((answer.force - Vector3(-0.05, -0.1, 0.15)).norm(), 1e-15);
  EXPECT_LT((answer.torque - Vector3(-0.005, 0.0, 0.01)).norm(), 1e-15);
}

TEST(Pid, ChangesItsGainsWithoutAJump) {
  // Between any two samples the command after the change is the one without it.
  for (const bool change : {false, true}) {
    ControlledRod loop(fast_sampling(), Vector3(0.0, 0.0, 1e-4));
    const Wrench load{Vector3(0.01, 0.0, 0.03), Vector3::Zero()};
    loop.run(0.02, load, 1e-5);
    static Wrench unchanged;
    PidSettings other = fast_sampling();
    other.natural_frequency = 35.0;
    other.setpoint_weight = 0.4;
    other.bond_compensation = 0.7;
    const Measurement m = measure(loop.rod, loop.time, {Vector3(0.02, 0.01, 0.0), Vector3::Zero()});
    loop.pid.follow(m, loop.target);
    if (change) loop.pid.set_settings(other);
    // The same measurement once more; the integral moves on by T w³ e.
    const Wrench next = loop.pid.follow(m, loop.target);
    if (!change) unchanged = next;
    EXPECT_LT((next.force - unchanged.force).norm(), 1e-9 + 1e-12);
    EXPECT_LT((next.torque - unchanged.torque).norm(), 1e-9);
    EXPECT_EQ(loop.pid.settings().period, 1e-5);
  }
}

TEST(Pid, StartsWithTheWrenchItIsHanded) {
  const RodState rod(lattice::rod_body({}, {}));
  Pid pid(PidSettings{}, rod.body().inertia_at_endpoint());
  Target target;
  target.pose.position = rod.endpoint() + Vector3(1e-4, 0.0, 2e-4);
  target.twist.velocity = Vector3(0.0, 0.0, 0.02);
  const Wrench held{Vector3(0.3, -0.2, 1.5), Vector3(0.01, 0.02, -0.03)};
  pid.start_from(held);
  const Wrench first =
      pid.follow(measure(rod, 0.0, {Vector3(0.1, 0.2, -0.3), Vector3(0.01, 0.0, 0.0)}), target);
  EXPECT_LT((first.force - held.force).norm(), 1e-13);
  EXPECT_LT((first.torque - held.torque).norm(), 1e-13);
}

TEST(Pid, SetPointWeightScalesTheProportionalAnswerToTheSetPointOnly) {
  const RodState rod(lattice::rod_body({}, {}));
  const double w = 2.0 * std::numbers::pi * 60.0, step = 1e-4;
  for (const double weight : {0.0, 0.3, 1.0}) {
    PidSettings settings;
    settings.setpoint_weight = weight;
    Pid pid(settings, rod.body().inertia_at_endpoint());
    Target target;
    target.pose.position = rod.endpoint();
    pid.follow(measure(rod, 0.0), target);
    target.pose.position.z() += step;
    const Wrench answer = pid.follow(measure(rod, 1e-3), target);
    EXPECT_NEAR(answer.force.z(), rod.body().mass * 3.0 * w * w * weight * step, 1e-12);
  }
}

TEST(Pid, WithoutSetPointWeightAStepIsReachedWithLessOvershoot) {
  // With Kp b r and the derivative on the error, y/r = (3 w s² + 3 b w² s + w³)/(s + w)³.
  const auto overshoot = [](double weight) {
    PidSettings settings = fast_sampling();
    settings.setpoint_weight = weight;
    ControlledRod loop(settings, Vector3::Zero());
    loop.run(2e-5, {}, 1e-5);  // the set point counts from the first one
    loop.target.pose.position.z() += 1e-3;
    double most = 0.0;
    while (loop.time < 0.1) {
      loop.run(1e-3, {}, 1e-5);
      most = std::max(most, loop.error() / 1e-3 - 1.0);
    }
    return most;
  };
  EXPECT_LT(overshoot(0.0), overshoot(1.0));
}
