#include "lattice/press/press.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "meshes/tables/table_rows.h"
#include "tests/expectations.h"
#include "tests/lattice/fixtures.h"
#include "tests/lattice/presses.h"

using namespace fingertip;
using namespace fixtures;
using lattice::ModelKind;
using lattice::PressOutcome;
using lattice::PressSetup;
using meshes::ContactMode;
using meshes::DriveMode;

namespace {

PressSetup setup_for(ModelKind kind, int per_radius, DriveMode mode, ContactMode contact) {
  PressSetup setup = presses::setup_of(
      {.model = kind, .per_radius = double(per_radius), .contact = contact, .mode = mode});
  if (kind == ModelKind::central) setup.lattice.constants.k1 *= 1.5;
  return setup;
}

/// A coarse hookean one that sticks.
PressSetup coarse(DriveMode mode) {
  return setup_for(ModelKind::hookean, 5, mode, ContactMode::stick);
}

/// Largest relative speed error from 50 ms on, outside the first 20 ms after first touch.
double speed_error(const PressOutcome& outcome, double speed) {
  double worst = 0.0;
  for (const auto& row : outcome.trace) {
    const double since_touch = row.time - outcome.first_touch_time;
    if (row.time < 0.05 || (since_touch >= 0.0 && since_touch <= 0.02)) continue;
    worst = std::max(worst, std::abs(row.speed - speed) / speed);
  }
  return worst;
}

double largest_tilt(const PressOutcome& outcome) {
  double worst = 0.0;
  for (const auto& row : outcome.trace) worst = std::max(worst, row.tilt);
  return worst;
}

void expect_the_papers_task(ModelKind kind, ContactMode contact) {
  const PressSetup setup = setup_for(kind, 8, DriveMode::pid, contact);
  const PressOutcome outcome = lattice::run_press(setup);
  EXPECT_LT(speed_error(outcome, setup.protocol.speed), 0.02) << name(kind);
  EXPECT_LT(largest_tilt(outcome), 0.1 * 3.14159 / 180.0) << name(kind);
  EXPECT_LT(outcome.momentum_defect, 1e-9) << name(kind);
  EXPECT_GT(outcome.response.samples().back().normal_force, 0.05) << name(kind);
  EXPECT_DOUBLE_EQ(outcome.response.depth(), setup.protocol.depth);
  EXPECT_NEAR(outcome.census.expected_particles, 2748.0, 1.0);
}

}  // namespace

TEST(PidPress, PublishedHoldsSpeedAndOrientationThroughContact) {
  expect_the_papers_task(ModelKind::published, ContactMode::stick);
}
TEST(PidPress, CentralHoldsSpeedAndOrientationThroughContact) {
  expect_the_papers_task(ModelKind::central, ContactMode::stick);
}
TEST(PidPress, HookeanHoldsSpeedAndOrientationThroughContact) {
  expect_the_papers_task(ModelKind::hookean, ContactMode::stick);
  expect_the_papers_task(ModelKind::hookean, ContactMode::frictionless);
}

TEST(PidPress, NetworkHoldsSpeedAndOrientationThroughContact) {
  expect_the_papers_task(ModelKind::network, ContactMode::stick);
}

TEST(QuasiStaticPress, HookeanComesCloseToTheContinuum) {
  // Independent axisymmetric finite elements, frictionless, small strain (default specimen):
  // indentation [cm], force [gf]. At R/8 few cells touch at first (lattice/MEASUREMENTS.md), and at
  // 1 cm/s the rubber's damping adds up to half a per cent.
  const PressOutcome outcome = lattice::run_press(
      setup_for(ModelKind::hookean, 8, DriveMode::quasi_static, ContactMode::frictionless));
  const double gf = 9.80665e-3;
  for (const auto& [depth, force] :
       {std::pair{0.05e-2, 1.02296}, {0.1e-2, 3.25628}, {0.2e-2, 10.22344}, {0.3e-2, 19.42179}}) {
    EXPECT_NEAR(outcome.response.normal_force_at(depth) / gf / force, 1.0,
                depth < 0.1e-2 ? 0.04 : 0.015)
        << depth;
  }
  EXPECT_LT(outcome.momentum_defect, 1e-9);
}

TEST(QuasiStaticPress, SymmetryLeavesNoLateralForceOrTorque) {
  const PressOutcome outcome = lattice::run_press(
      setup_for(ModelKind::hookean, 6, DriveMode::quasi_static, ContactMode::stick));
  ASSERT_GT(outcome.response.samples().size(), 3U);
  EXPECT_GT(outcome.response.samples().back().normal_force, 0.05);
  for (const auto& sample : outcome.response.samples()) {
    EXPECT_LT(std::hypot(sample.lateral_force_x, sample.lateral_force_y),
              1e-9 * (sample.normal_force + 1e-3));
    EXPECT_LT(std::hypot(sample.torque_x, sample.torque_y, sample.torque_z),
              1e-11 * (sample.normal_force + 1e-3));
  }
}

TEST(QuasiStaticPress, PlaneAndBondCarryTheSameForce) {
  const PressOutcome outcome = lattice::run_press(
      setup_for(ModelKind::hookean, 6, DriveMode::quasi_static, ContactMode::stick));
  const auto& row = outcome.trace[outcome.trace.size() - 10];
  EXPECT_GT(row.normal_force, 0.05);
  EXPECT_NEAR(row.plane_force, row.normal_force, 0.01 * row.normal_force);
}

TEST(Press, ResultDoesNotDependOnTheNumberOfThreads) {
  for (const ModelKind kind : {ModelKind::published, ModelKind::hookean, ModelKind::network}) {
    PressSetup setup = setup_for(kind, 6, DriveMode::pid, ContactMode::stick);
    setup.protocol.depth = 1.5e-3;
    setup.protocol.speed = 2e-2;
    setup.threads = 1;
    const PressOutcome first = lattice::run_press(setup);
    setup.threads = 2;
    const PressOutcome second = lattice::run_press(setup);
    ASSERT_EQ(first.trace.size(), second.trace.size());
    for (std::size_t i = 0; i < first.response.samples().size(); ++i) {
      EXPECT_EQ(first.response.samples()[i].normal_force,
                second.response.samples()[i].normal_force);
    }
    EXPECT_EQ(first.snapshots.back().boundary, second.snapshots.back().boundary);
  }
}

TEST(Press, ExplicitEulerPressesThePublishedModelLikeSymplecticEuler) {
  PressSetup setup =
      setup_for(ModelKind::published, 5, DriveMode::quasi_static, ContactMode::stick);
  setup.protocol.depth = 2e-3;
  const PressOutcome symplectic = lattice::run_press(setup);
  setup.integrator = lattice::Integrator::explicit_euler;
  const PressOutcome explicit_euler = lattice::run_press(setup);
  const double force = symplectic.response.normal_force_at(2e-3);
  EXPECT_GT(force, 0.05);
  EXPECT_NEAR(explicit_euler.response.normal_force_at(2e-3), force, 0.01 * force);
}

TEST(Press, SamplesAreAtTheDepthsAskedForAndEvenlyBetween) {
  PressSetup setup = coarse(DriveMode::quasi_static);
  setup.protocol.depth = 1e-3;
  setup.protocol.samples = {0.123e-3, 0.5e-3, 1e-3};
  const PressOutcome outcome = lattice::run_press(setup);
  const auto& rows = outcome.response.samples();
  EXPECT_EQ(rows.size(), 61u);  // 60 even depths, two of which are samples, and 0.123 mm
  EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end(), [](const auto& a, const auto& b) {
    return a.indentation < b.indentation;
  }));
  EXPECT_TRUE(std::any_of(rows.begin(), rows.end(),
                          [](const auto& row) { return row.indentation == 0.123e-3; }));
  for (const auto& row : rows) EXPECT_FALSE(std::isnan(row.time));
}

TEST(Press, SmallerStepsChangeTheForceLessAndLess) {
  PressSetup setup = coarse(DriveMode::quasi_static);
  const PressOutcome coarse = lattice::run_press(setup);
  setup.time_step = 0.5 * coarse.step.step;
  const PressOutcome medium = lattice::run_press(setup);
  setup.time_step = 0.125 * coarse.step.step;
  const PressOutcome fine = lattice::run_press(setup);
  for (const double depth : {1e-3, 2e-3, 3e-3}) {
    const double force = fine.response.normal_force_at(depth);
    EXPECT_NEAR(coarse.response.normal_force_at(depth), force, 5e-3 * force) << depth;
    EXPECT_NEAR(medium.response.normal_force_at(depth), force, 1.5e-3 * force) << depth;
  }
}

TEST(Press, RefusesBrokenSetups) {
  PressSetup setup = coarse(DriveMode::pid);
  setup.time_step = 1e-3;
  const auto press = [&] { lattice::run_press(setup); };
  EXPECT_TRUE(refuses<meshes::InvalidInput>(press, "run.time_step"));
  setup.time_step.reset();
  setup.lattice.constants = {};
  setup.controller.period = 0.0;
  setup.rod.density = -1.0;
  setup.threads = -1;
  setup.lattice.ligament_stiffness = std::nan("");
  EXPECT_EQ(setup.violations().size(), 5u);
  EXPECT_TRUE(refuses<meshes::InvalidInput>(press, {"controller.period", "rod.density"}));
}

TEST(Press, ARodLighterThanTheRubberIsRefusedUnderTheController) {
  PressSetup setup = coarse(DriveMode::pid);
  setup.rod.density = 300.0;
  ASSERT_EQ(setup.violations().size(), 1u);
  EXPECT_EQ(setup.violations()[0].key, "rod.density");
  setup.protocol.mode = DriveMode::quasi_static;  // nothing is fed back
  EXPECT_TRUE(setup.violations().empty());
}

TEST(Press, ExplicitEulerIsForThePublishedModelAlone) {
  // The published model's dampers do not depend on the rubber's retardation time.
  PressSetup setup = setup_for(ModelKind::published, 5, DriveMode::pid, ContactMode::stick);
  setup.integrator = lattice::Integrator::explicit_euler;
  EXPECT_TRUE(setup.violations().empty());
  for (const ModelKind kind : cell_models) {
    setup = setup_for(kind, 5, DriveMode::pid, ContactMode::stick);
    setup.integrator = lattice::Integrator::explicit_euler;
    ASSERT_EQ(setup.violations().size(), 1u) << name(kind);
    EXPECT_EQ(setup.violations()[0].key, "run.integrator");
    EXPECT_TRUE(
        refuses<meshes::InvalidInput>([&] { lattice::run_press(setup); }, "run.integrator"));
  }
}

TEST(Press, StopsWhenTheObserverAsksAndKeepsWhatItHas) {
  const PressSetup setup = coarse(DriveMode::quasi_static);
  std::size_t rows = 0;
  EXPECT_THROW(lattice::run_press(setup,
                                  [&](const PressOutcome& so_far, double done) {
                                    rows = so_far.response.samples().size();
                                    EXPECT_GE(done, 0.0);
                                    return so_far.response.depth() < 1e-3;
                                  }),
               meshes::Interrupted);
  EXPECT_GT(rows, 15u);
}

TEST(Press, AnActuatorTooWeakEndsAsNotConverged) {
  PressSetup setup = coarse(DriveMode::pid);
  setup.controller.force_limit = 0.02;
  PressOutcome last;
  EXPECT_TRUE(refuses<meshes::NotConverged>(
      [&] {
        lattice::run_press(setup, [&](const PressOutcome& so_far, double) {
          last = so_far;
          return true;
        });
      },
      {"controller.force_limit = 0.02 N", "controller.torque_limit = 1 N m",
       "take controller.force_limit = \"", " N m\", or press less deep"}));
  EXPECT_GT(last.response.depth(), 0.0);
  EXPECT_FALSE(last.trace.empty());
}

TEST(Press, AnUnstableControllerEndsAsNotConverged) {
  PressSetup setup = coarse(DriveMode::pid);
  setup.controller.natural_frequency = 250.0;
  EXPECT_THROW(lattice::run_press(setup), meshes::NotConverged);
}

TEST(Press, TheTraceKnowsTheRodsKineticEnergy) {
  PressSetup setup = coarse(DriveMode::quasi_static);
  setup.protocol.speed = 0.05;
  setup.protocol.depth = 1e-3;
  setup.protocol.samples = {1e-3};
  const PressOutcome outcome = lattice::run_press(setup);
  const double mass = lattice::rod_body(setup.geometry, setup.rod).mass;
  for (const lattice::TraceRow& row : outcome.trace)
    EXPECT_NEAR(row.rod_kinetic_energy, 0.5 * mass * row.speed * row.speed,
                1e-9 * mass * 0.05 * 0.05);
  EXPECT_GT(outcome.trace.back().rod_kinetic_energy, 0.0);
  EXPECT_GT(outcome.trace.back().kinetic_energy, 0.0);
}

TEST(Press, WritesATraceWithNamesAndUnits) {
  const auto file = std::filesystem::path(testing::TempDir()) / "trace.csv";
  lattice::TraceRow row;
  row.time = 0.25;
  row.anchored = 3;
  meshes::write_rows(std::vector{row}, file);
  std::ifstream in(file);
  std::string names, values;
  std::getline(in, names);
  std::getline(in, values);
  EXPECT_EQ(std::count(names.begin(), names.end(), ','), 17);
  EXPECT_EQ(std::count(values.begin(), values.end(), ','), 17);
  EXPECT_TRUE(says(names, ",particles_kinetic_energy [J],rod_kinetic_energy [J],"));
  EXPECT_EQ(names.substr(0, 26), "time [s],indentation [m],c");
  EXPECT_EQ(values.substr(0, 5), "0.25,");
}
