#include "lattice/grasp/grip.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lattice/grasp/grasp.h"

using namespace fingertip;
using lattice::GripControl;
using lattice::GripFeeling;
using lattice::GripMotion;
using lattice::GripPhase;
using lattice::GripSettings;

namespace {

/// A grasp of springs whose answers are known: F = c indentation^1.5, load = rise/sag.
struct SpringHand {
  double hertz = 1200.0;  ///< [N/m^1.5]
  double sag = 1e-3;      ///< rise at which the block's weight is carried [m]
  double clearance = 5e-4;
  double closed = 0.0, risen = 0.0, time = 0.0;
  bool supported = true;

  GripFeeling feel() const {
    const double depth = closed - clearance;
    return {time, depth > 0.0 ? hertz * std::pow(depth, 1.5) : 0.0, depth, risen / sag, supported};
  }
  void move(const GripMotion& before, const GripMotion& after, double period) {
    closed += 0.5 * period * (before.closing + after.closing);
    risen += 0.5 * period * (before.rising + after.rising);
    time += period;
    if (risen >= sag) supported = false;
  }
};

}  // namespace

TEST(GripControl, GoesThroughAllPhasesOnSprings) {
  GripSettings settings;
  settings.release_time = 2.0;
  GripControl control(settings);
  SpringHand hand;
  GripMotion last;
  double highest_force = 0.0, rise_at_lift = 0.0, fastest = 0.0, largest_jump = 0.0;
  while (control.phase() != GripPhase::done && hand.time < 5.0) {
    const GripMotion next = control.next(hand.feel());
    if (control.phase() == GripPhase::lift && rise_at_lift == 0.0) rise_at_lift = hand.risen;
    if (control.phase() == GripPhase::lift) fastest = std::max(fastest, next.rising);
    largest_jump = std::max(largest_jump, std::abs(next.rising - last.rising));
    hand.move(last, next, settings.period);
    last = next;
    highest_force = std::max(highest_force, hand.feel().force);
  }
  EXPECT_EQ(control.phase(), GripPhase::done);
  EXPECT_LT(highest_force, 1.02 * settings.force);
  EXPECT_NEAR(hand.risen - rise_at_lift, settings.lift_height, 0.01 * settings.lift_height);
  EXPECT_NEAR(fastest, settings.lift_speed, 1e-4 * settings.lift_speed);
  EXPECT_LE(largest_jump, 0.0501 * settings.lift_speed);
  // A falling set point is followed with the lag T dF/dt.
  const double end = (0.05 + settings.time_constant / settings.release_time) * settings.force;
  EXPECT_NEAR(hand.feel().force, end, 2e-3 * settings.force);
}

TEST(GripControl, LiftIsThePathOfLeastJerk) {
  GripSettings settings;
  settings.lift_height = 0.01;
  settings.lift_speed = 0.05;
  // Numerically from z = h (10 s³ - 15 s⁴ + 6 s⁵).
  const double h = settings.lift_height, period = settings.lift_time();
  double speed = 0.0, acceleration = 0.0;
  for (int i = 0; i <= 10000; ++i) {
    const double s = i / 10000.0;
    speed = std::max(speed, h / period * (30 * s * s - 60 * s * s * s + 30 * s * s * s * s));
    acceleration =
        std::max(acceleration, h / (period * period) * (60 * s - 180 * s * s + 120 * s * s * s));
  }
  EXPECT_NEAR(speed, settings.lift_speed, 1e-6);
  EXPECT_NEAR(acceleration, settings.lift_acceleration(), 1e-6);
}

TEST(GraspSetup, FrictionLimit) {
  lattice::GraspSetup setup;
  setup.hand.block.mass = 0.01;
  setup.hand.gravity = 9.81;
  setup.hand.finger.contact = {meshes::ContactMode::coulomb, 0.4};
  EXPECT_NEAR(setup.least_force(0.19), 0.01 * 10.0 / 0.8, 1e-15);
  setup.hand.finger.contact = {meshes::ContactMode::stick};
  EXPECT_EQ(setup.least_force(0.0), 0.0);
  setup.hand.finger.contact = {meshes::ContactMode::frictionless};
  EXPECT_TRUE(std::isinf(setup.least_force(0.0)));
}
