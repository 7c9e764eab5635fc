#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "lattice/control/approach.h"
#include "lattice/control/pid.h"

using namespace fingertip;
using lattice::Approach;
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
  m.position = rod.endpoint();
  m.orientation = rod.pose().orientation;
  m.velocity = rod.velocity_at(rod.endpoint());
  m.angular_velocity = rod.angular_velocity();
  m.bond = bond;
  return m;
}

/// A controlled rod without a tip, disturbed by a wrench at its endpoint that the controller does
/// not see.
struct ControlledRod {
  RodState rod{lattice::rod_body({}, {})};
  Pid pid;
  double time = 0.0, next = 0.0;
  Wrench command;

  ControlledRod(const PidSettings& settings, const Vector3& shift)
      : pid(settings, rod.body().inertia_at_endpoint(),
            [at = Vector3(rod.body().endpoint + shift)](double) {
              return Target{at, Vector3::Zero(), Vector3::Zero()};
            }) {}

  void run(double duration, const Wrench& disturbance, double dt = 1e-6) {
    for (const double end = time + duration; time < end - 0.5 * dt; time += dt) {
      if (time >= next - 0.5 * dt) {
        command = pid.command(measure(rod, time));
        next += pid.period();
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
  Pid pid(settings, rod.body().inertia_at_endpoint(), [&](double) {
    return Target{rod.endpoint(), {0, 0, 0}, {0, 0, 0}};
  });
  const Wrench answer =
      pid.command(measure(rod, 0.0, {Vector3(0.1, 0.2, -0.3), Vector3(0.01, 0.0, -0.02)}));
  EXPECT_LT((answer.force - Vector3(-0.05, -0.1, 0.15)).norm(), 1e-15);
  EXPECT_LT((answer.torque - Vector3(-0.005, 0.0, 0.01)).norm(), 1e-15);
}

TEST(Approach, SpeedAndAccelerationAreDerivativesOfTheDistance) {
  const Approach approach(0.01, 0.5e-3);
  const double h = 1e-6;
  for (double t = 0.001; t < 0.05; t += 0.0037) {
    const auto at = approach.at(t), later = approach.at(t + h), earlier = approach.at(t - h);
    EXPECT_NEAR(at.speed, (later.distance - earlier.distance) / (2 * h), 1e-8);
    EXPECT_NEAR(at.acceleration, (later.speed - earlier.speed) / (2 * h), 1e-4);
  }
}

TEST(Approach, StartsFromRestAndReachesItsSpeedBeforeThePlane) {
  for (const double speed : {0.001, 0.01, 0.2}) {
    const double clearance = 0.5e-3;
    const Approach approach(speed, clearance);
    EXPECT_EQ(approach.at(0.0).speed, 0.0);
    EXPECT_EQ(approach.at(0.0).acceleration, 0.0);
    EXPECT_LE(approach.rise_time(), 0.03);
    EXPECT_LE(approach.at(approach.rise_time()).distance, 0.5 * clearance * (1.0 + 1e-12));
    EXPECT_NEAR(approach.at(approach.time_at(clearance)).distance, clearance, 1e-15);
    EXPECT_EQ(approach.at(approach.rise_time()).speed, speed);
  }
}
