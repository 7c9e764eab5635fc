#include "lattice/grasp/grasp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace fingertip;
using lattice::GraspFate;
using lattice::GraspOutcome;
using lattice::GraspSetup;
using meshes::ContactMode;

namespace {

GraspSetup coarse(ContactMode contact) {
  GraspSetup setup;
  lattice::FingerSetup& finger = setup.hand.finger;
  finger.lattice.spacing = 0.01 / 6;
  finger.lattice.constants = lattice::hookean_constants(finger.rubber, finger.lattice.spacing);
  finger.contact = {contact, 0.5};
  finger.threads = 1;
  setup.grip.hold_time = 0.1;
  return setup;
}

const GraspOutcome& sticking() {
  static const GraspOutcome outcome = lattice::run_grasp(coarse(ContactMode::stick));
  return outcome;
}

/// Lifted fast, to be cheap.
GraspSetup rubbing() {
  GraspSetup setup = coarse(ContactMode::coulomb);
  setup.grip.lift_speed = 0.02;
  setup.grip.lift_height = 4e-3;
  return setup;
}

/// Squeezing presses the rubber outward, so friction pulls the points toward the centre. The load
/// turns it; what they carry together never exceeds what they carry one by one, nor that mu n.
void expect_friction_of_points(const GraspOutcome& outcome) {
  bool loaded = false;
  for (const lattice::GraspRow& row : outcome.rows) {
    for (std::size_t side = 0; side < 2; ++side) {
      const double most = 0.5 * row.normal[side];
      if (row.phase == lattice::GripPhase::load && !loaded) {
        EXPECT_GT(row.inward_friction[side], 0.2 * most);
        EXPECT_LT(row.tangential[side], 0.05 * most);
      }
      if (row.phase != lattice::GripPhase::load) continue;
      EXPECT_LT(row.point_friction[side], 1.002 * most);
      EXPECT_LT(row.tangential[side], 1.002 * row.point_friction[side]);
    }
    loaded = loaded || row.phase == lattice::GripPhase::load;
  }
  EXPECT_TRUE(loaded);
  const lattice::GraspRow& last = outcome.rows.back();
  EXPECT_NEAR(last.point_friction[0], 0.5 * last.normal[0], 1e-3 * last.normal[0]);
  EXPECT_LT(last.inward_friction[0], 0.05 * last.normal[0]);
}

}  // namespace

TEST(Grasp, CarriesTheWeightByTangentialForces) {
  const GraspSetup setup = coarse(ContactMode::stick);
  const GraspOutcome& outcome = sticking();
  ASSERT_EQ(outcome.fate, GraspFate::held);
  EXPECT_NEAR(outcome.held_force, setup.grip.force, 2e-3 * setup.grip.force);
  EXPECT_NEAR(outcome.held_load, 1.0, 1e-3);
  const double weight = setup.hand.block.mass * setup.hand.gravity;
  EXPECT_NEAR(outcome.held_ratio, 0.5 * weight / outcome.held_force, 1e-3);
  const lattice::GraspRow& last = outcome.rows.back();
  EXPECT_NEAR(last.height, setup.grip.lift_height, 1e-5);
  // Two alike fingers: each carries half, and nothing turns.
  EXPECT_NEAR(last.normal[0], last.normal[1], 1e-9 * last.normal[0]);
  EXPECT_NEAR(last.tangential[0], last.tangential[1], 1e-9 * last.tangential[0]);
  EXPECT_LT(last.tilt, 1e-12);
}

TEST(Grasp, MomentumOfTipsAndBlockBalances) {
  // Against what rods, gravity and support gave, support and lift-off included.
  EXPECT_GT(sticking().momentum_defect, 0.0);
  EXPECT_LT(sticking().momentum_defect, 1e-10);
}

TEST(Grasp, NewtonHoldsForTheBlockInEveryPeriod) {
  // m (z(t+T) - 2 z(t) + z(t-T))/T² against the forces there, over the lift.
  const GraspSetup setup = coarse(ContactMode::stick);
  const GraspOutcome& outcome = sticking();
  const double weight = setup.hand.block.mass * setup.hand.gravity;
  double worst = 0.0, largest = 0.0;
  for (std::size_t i = 1; i + 1 < outcome.rows.size(); ++i) {
    const auto& row = outcome.rows[i];
    if (row.phase != lattice::GripPhase::lift || row.time < outcome.lift_off_time + 5e-3) continue;
    const double acceleration =
        (outcome.rows[i + 1].velocity - outcome.rows[i - 1].velocity) / (2.0 * setup.grip.period);
    worst = std::max(worst, std::abs(setup.hand.block.mass * acceleration - row.load + weight));
    largest = std::max(largest, std::abs(row.load - weight));
  }
  ASSERT_GT(largest, 1e-4);
  EXPECT_LT(worst, 0.15 * largest);
}

TEST(Grasp, WithoutFrictionTheBlockStays) {
  const GraspOutcome outcome = lattice::run_grasp(coarse(ContactMode::frictionless));
  EXPECT_EQ(outcome.fate, GraspFate::not_lifted);
  EXPECT_EQ(outcome.rows.back().height, 0.0);
  EXPECT_NEAR(outcome.rows.back().load, 0.0, 1e-12);
}

// Two contacts carry at most mu N each: the block is held iff 2 mu N >= m (g + a).

TEST(GraspAtTheFrictionLimit, HoldsThreePercentAbove) {
  GraspSetup setup = rubbing();
  setup.grip.force = 1.03 * setup.least_force(setup.grip.lift_acceleration());
  const GraspOutcome outcome = lattice::run_grasp(setup);
  EXPECT_EQ(outcome.fate, GraspFate::held);
  EXPECT_LT(std::abs(outcome.held_slip), 1e-4);
  EXPECT_NEAR(outcome.held_load, 1.0, 2e-3);
  EXPECT_NEAR(outcome.held_ratio, 0.5 / (outcome.held_force / setup.least_force(0.0)), 2e-3);
}

TEST(GraspAtTheFrictionLimit, DoesNotLiftThreePercentBelow) {
  GraspSetup setup = rubbing();
  setup.grip.force = 0.97 * setup.least_force(0.0);
  const GraspOutcome outcome = lattice::run_grasp(setup);
  EXPECT_EQ(outcome.fate, GraspFate::not_lifted);
  const lattice::GraspRow& last = outcome.rows.back();
  EXPECT_EQ(last.height, 0.0);
  EXPECT_EQ(last.sliding[0], last.touching[0]);
  // Both contacts slide and carry what friction can.
  EXPECT_NEAR(last.load, 0.5 * (last.normal[0] + last.normal[1]), 0.01 * last.load);
  EXPECT_NEAR(outcome.slip_ratio, 0.5, 0.03 * 0.5);
  EXPECT_NEAR(outcome.sliding_ratio, 0.5, 0.01 * 0.5);
  EXPECT_LT(outcome.momentum_defect, 1e-10);
  expect_friction_of_points(outcome);
}

TEST(GraspAtTheFrictionLimit, DropsTheBlockWhereTheGripFallsBelow) {
  GraspSetup setup = rubbing();
  setup.grip.force = 1.25 * setup.least_force(0.0);
  setup.grip.release_time = 3.0;
  const GraspOutcome outcome = lattice::run_grasp(setup);
  EXPECT_EQ(outcome.fate, GraspFate::held);
  EXPECT_NEAR(outcome.slip_force, setup.least_force(0.0), 0.03 * setup.least_force(0.0));
  const lattice::GraspRow& last = outcome.rows.back();
  EXPECT_GE(last.slip, setup.grip.slip_limit);
  EXPECT_LT(last.velocity, 0.0);
  for (std::size_t side = 0; side < 2; ++side) {
    EXPECT_NEAR(last.tangential[side], 0.5 * last.normal[side], 0.005 * last.normal[side]);
  }
}

TEST(Grasp, HalfTheStepChangesNothing) {
  GraspSetup setup = coarse(ContactMode::stick);
  const GraspOutcome& whole = sticking();
  setup.hand.finger.time_step = 0.5 * whole.step;
  const GraspOutcome half = lattice::run_grasp(setup);
  EXPECT_NEAR(half.step, 0.5 * whole.step, 1e-9);
  EXPECT_NEAR(half.held_force, whole.held_force, 1e-3 * whole.held_force);
  EXPECT_NEAR(half.rows.back().indentation, whole.rows.back().indentation,
              2e-3 * whole.rows.back().indentation);
  EXPECT_NEAR(half.rows.back().finger_height, whole.rows.back().finger_height,
              2e-3 * whole.rows.back().finger_height);
  EXPECT_NEAR(half.lift_off_time, whole.lift_off_time, 5e-3);
}

TEST(Grasp, RefusesWhatItCannotDo) {
  GraspSetup setup = coarse(ContactMode::stick);
  setup.hand.finger.lattice.model = lattice::ModelKind::published;
  setup.hand.block.mass = -1.0;
  setup.grip.force = 0.0;
  setup.grip.time_constant = 1e-4;
  setup.hand.gravity = 0.0;
  try {
    lattice::run_grasp(setup);
    FAIL() << "accepted";
  } catch (const meshes::InvalidInput& error) {
    std::vector<std::string> keys;
    for (const auto& violation : error.violations()) {
      keys.push_back(violation.key);
      EXPECT_FALSE(violation.remedy.empty());
    }
    EXPECT_EQ(keys,
              (std::vector<std::string>{"grasp.block_mass", "grasp.force", "grasp.time_constant",
                                        "grasp.gravity", "lattice.model"}));
  }
}

TEST(Grasp, TellsWhenTheRubberIsTooThinForTheForce) {
  GraspSetup setup = coarse(ContactMode::stick);
  setup.grip.force = 3.0;
  setup.grip.closing_speed = 0.1;
  bool seen = false;
  EXPECT_THROW(lattice::run_grasp(setup,
                                  [&](const GraspOutcome& so_far, double) {
                                    seen = !so_far.rows.empty();
                                    return true;
                                  }),
               meshes::NotConverged);
  EXPECT_TRUE(seen);
}

TEST(Grasp, CanBeStopped) {
  EXPECT_THROW(
      lattice::run_grasp(coarse(ContactMode::stick),
                         [](const GraspOutcome& so_far, double) { return so_far.rows.empty(); }),
      meshes::Interrupted);
}
