// Presses in stages: the moving lattice and the one at rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lattice/dynamics/integrators/energy_balance.h"
#include "lattice/press/press.h"
#include "lattice/press/press_task.h"
#include "lattice/press/static_press.h"
#include "tests/coarse_press.h"

using namespace fingertip;
using lattice::Integrator;
using lattice::PressOutcome;
using lattice::PressSetup;
using meshes::ContactMode;
using meshes::DriveMode;
using meshes::PressSample;
using meshes::PressStage;

namespace {

constexpr double depth = 1e-3;  // [m]

PressStage move(double indentation, double speed = 0.01) {
  return {indentation, speed, 0.0};
}
PressStage hold(double indentation, double time) {
  return {indentation, 0.0, time};
}

PressSetup with_program(std::vector<PressStage> program,
                        ContactMode contact = ContactMode::frictionless,
                        DriveMode mode = DriveMode::quasi_static) {
  PressSetup setup = coarse_press();
  setup.protocol.program = std::move(program);
  setup.protocol.speed = setup.protocol.program.front().speed;
  setup.protocol.depth = depth;
  setup.protocol.samples = {0.25e-3, 0.5e-3, 0.75e-3, depth};
  setup.protocol.contact = contact;
  setup.protocol.mode = mode;
  EXPECT_TRUE(setup.violations().empty());
  return setup;
}

/// The last row of a stage, from 1.
PressSample end_of(const meshes::PressResponse& response, int stage) {
  PressSample found;
  for (const PressSample& sample : response.samples())
    if (sample.stage == stage) found = sample;
  EXPECT_EQ(found.stage, stage);
  return found;
}

}  // namespace

TEST(ProgramPress, TheFirstLoadingIsTheUsualPressUntilTheRodSlowsDown) {
  PressSetup usual = with_program({move(depth)});
  const PressOutcome program = lattice::run_press(usual);
  usual.protocol.program.clear();
  const PressOutcome press = lattice::run_press(usual);
  // The rod slows down over the last half of vT.
  const meshes::PressMotion motion(with_program({move(depth)}).protocol);
  const double uniform = depth - 0.5 * usual.protocol.speed * motion.rise_time();
  std::size_t compared = 0;
  for (const PressSample& sample : program.response.pressing()) {
    if (sample.indentation > uniform - 1e-5) continue;
    const PressSample& other = press.response.samples()[compared++];
    EXPECT_EQ(sample.indentation, other.indentation);
    EXPECT_NEAR(sample.normal_force, other.normal_force, 1e-9 * std::abs(other.normal_force));
  }
  EXPECT_GT(compared, 10u);
  EXPECT_EQ(program.response.depth(), depth);
  EXPECT_TRUE(program.response.following().empty());
  // Slowly both are in equilibrium.
  EXPECT_NEAR(program.response.normal_force_at(depth), press.response.normal_force_at(depth),
              0.02 * press.response.normal_force_at(depth));
  EXPECT_EQ(program.trace.back().commanded_speed, 0.0);
}

TEST(ProgramPress, RowsFollowInTimeAndTellTheirStage) {
  const PressSetup setup =
      with_program({move(depth), hold(depth, 0.05), move(0.3e-3), move(0.6e-3, 0.02)});
  const PressOutcome outcome = lattice::run_press(setup);
  const meshes::PressMotion motion(setup.protocol);
  const auto following = outcome.response.following();
  std::vector<meshes::MotionSample> wanted;
  for (const meshes::MotionSample& sample : motion.samples())
    if (sample.stage > 0) wanted.push_back(sample);
  ASSERT_EQ(following.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_EQ(following[i].time, wanted[i].time);
    EXPECT_EQ(following[i].indentation, wanted[i].indentation);
    EXPECT_EQ(following[i].stage, double(wanted[i].stage + 1));
    EXPECT_GT(following[i].normal_force, 0.0);
  }
  EXPECT_EQ(outcome.response.pressing().back().indentation, depth);
  EXPECT_EQ(outcome.response.pressing().back().stage, 1.0);
  EXPECT_EQ(outcome.response.deepest(), depth);
  EXPECT_NEAR(outcome.simulated_time, motion.duration(), 2e-3);
}

TEST(ProgramPress, TheAreaOfTheLoopIsWhatTheRubberDissipates) {
  // Down and up again off the plane, at rest at both ends. What dampers dissipate is measured apart
  // from the force on the rod, from the forces with and without damping (EnergyBalance).
  PressSetup setup = with_program({move(depth, 0.05), move(-0.2e-3, 0.05), hold(-0.2e-3, 0.1)});
  setup.rubber.retardation_time = 3e-3;
  const PressOutcome outcome = lattice::run_press(setup);

  const lattice::PressWay way(setup.protocol, setup.geometry);
  lattice::VirtualFinger finger(finger_setup(setup, way));
  const meshes::PressMotion motion(setup.protocol);
  finger.write([&](double time) {
    const meshes::SetPoint point = motion.at(time);
    return lattice::RodMotion{point.distance * way.direction, point.speed * way.direction};
  });
  lattice::EnergyBalance balance(finger.finger());
  lattice::EnergyInstant before = balance.measure(true);
  double dissipated = 0.0, time = 0.0;
  finger.do_step(motion.duration(), [&] {
    const lattice::EnergyInstant now = balance.measure(true);
    dissipated += 0.5 * (before.dissipation + now.dissipation) * (finger.time() - time);
    before = now;
    time = finger.time();
    return true;
  });
  const double left = before.kinetic + before.stored;
  EXPECT_GT(outcome.work, 0.0);
  EXPECT_GT(outcome.work_in, outcome.work);
  EXPECT_NEAR(outcome.work, dissipated + left, 0.01 * dissipated);
  EXPECT_LT(left, 0.01 * dissipated);
}

TEST(ProgramPress, AfterAHoldTheForceIsThatOfEquilibrium) {
  for (const ContactMode contact : {ContactMode::frictionless, ContactMode::stick}) {
    PressSetup setup = with_program({move(depth), hold(depth, 0.2)}, contact);
    setup.rubber.retardation_time = 3e-3;
    const PressOutcome moving = lattice::run_press(setup);
    const PressSample end = end_of(moving.response, 2);
    setup.protocol.mode = DriveMode::equilibrium;
    const PressSample rest = lattice::run_static_press(setup).response.samples().back();
    EXPECT_EQ(rest.indentation, depth);
    // On the way the dampers push, too.
    EXPECT_GT(moving.response.normal_force_at(0.5 * depth),
              1.01 * lattice::run_static_press(setup).response.normal_force_at(0.5 * depth));
    EXPECT_NEAR(end.normal_force, rest.normal_force, 2e-3 * rest.normal_force) << name(contact);
  }
}

TEST(ProgramPress, LetsGoOfThePlaneAndTouchesAgain) {
  for (const ContactMode contact :
       {ContactMode::frictionless, ContactMode::stick, ContactMode::coulomb}) {
    const PressOutcome outcome = lattice::run_press(
        with_program({move(depth), move(-0.2e-3), hold(-0.2e-3, 0.2), move(depth)}, contact));
    const double peak = end_of(outcome.response, 1).normal_force,
                 off = end_of(outcome.response, 3).normal_force,
                 again = end_of(outcome.response, 4).normal_force;
    EXPECT_GT(peak, 0.01);
    EXPECT_LT(std::abs(off), 2e-3 * peak) << name(contact);
    EXPECT_NEAR(again, peak, 0.01 * peak) << name(contact);
    const meshes::PressMotion motion(
        with_program({move(depth), move(-0.2e-3), hold(-0.2e-3, 0.2), move(depth)}).protocol);
    for (const lattice::TraceRow& row : outcome.trace)
      if (row.time > motion.stages()[1].end + 2e-3 && row.time < motion.stages()[2].end) {
        EXPECT_EQ(row.anchored, 0) << name(contact);
      }
    EXPECT_GT(outcome.trace.back().anchored, 0) << name(contact);
    EXPECT_LT(outcome.momentum_defect, 1e-9);
  }
}

TEST(ProgramPress, ThePublishedLatticeLetsGoUnlessItSticksTillTheEnd) {
  PressSetup setup = with_program({move(depth, 0.05), move(-0.2e-3, 0.05), hold(-0.2e-3, 0.2)});
  setup.lattice.model = lattice::ModelKind::published;
  setup.lattice.kinematics = lattice::Kinematics::finite;
  setup.lattice.constants = lattice::published_constants(setup.rubber, setup.lattice.spacing);
  EXPECT_EQ(lattice::run_press(setup).trace.back().anchored, 0);
  setup.protocol.contact = ContactMode::stick;  // paper, II.F
  ASSERT_EQ(setup.violations().size(), 1u);
  EXPECT_EQ(setup.violations()[0].key, "press.program");
  setup.protocol.mode = DriveMode::equilibrium;
  EXPECT_TRUE(setup.violations().empty());
}

TEST(ProgramPress, EveryIntegratorFollowsIt) {
  const std::vector<PressStage> program = {move(depth), hold(depth, 0.2), move(0.0),
                                           hold(0.0, 0.2)};
  const PressOutcome usual = lattice::run_press(with_program(program));
  const double force = end_of(usual.response, 2).normal_force;
  for (const Integrator integrator :
       {Integrator::runge_kutta, Integrator::energy_controlled, Integrator::mass_scaled}) {
    PressSetup setup = with_program(program);
    setup.integrator = integrator;
    const PressOutcome outcome = lattice::run_press(setup);
    ASSERT_EQ(outcome.response.following().size(), usual.response.following().size());
    EXPECT_NEAR(end_of(outcome.response, 2).normal_force, force, 5e-3 * force) << name(integrator);
    EXPECT_NEAR(end_of(outcome.response, 4).normal_force, 0.0, 5e-3 * force) << name(integrator);
  }
}

TEST(ProgramPress, AControllerFollowsIt) {
  const std::vector<PressStage> program = {move(depth), hold(depth, 0.2), move(-0.2e-3),
                                           hold(-0.2e-3, 0.2)};
  const PressOutcome told = lattice::run_press(with_program(program));
  const PressOutcome outcome =
      lattice::run_press(with_program(program, ContactMode::frictionless, DriveMode::pid));
  EXPECT_EQ(outcome.response.depth(), depth);
  const auto following = outcome.response.following();
  ASSERT_EQ(following.size(), told.response.following().size());
  double farthest = 0.0;
  for (std::size_t i = 0; i < following.size(); ++i) {
    EXPECT_EQ(following[i].time, told.response.following()[i].time);
    farthest = std::max(
        farthest, std::abs(following[i].indentation - told.response.following()[i].indentation));
  }
  EXPECT_LT(farthest, 0.01 * depth);
  for (const int stage : {1, 2})
    EXPECT_NEAR(end_of(outcome.response, stage).normal_force,
                end_of(told.response, stage).normal_force,
                0.01 * end_of(told.response, stage).normal_force);
  EXPECT_NEAR(end_of(outcome.response, 4).normal_force, 0.0, 1e-3);
}

TEST(ProgramPress, AnActuatorTooWeakForTheWayEndsAsNotConverged) {
  PressSetup setup =
      with_program({move(depth), hold(depth, 2.0)}, ContactMode::stick, DriveMode::pid);
  setup.controller.force_limit = 0.01;
  EXPECT_THROW(lattice::run_press(setup), meshes::NotConverged);
}

TEST(StaticProgramPress, WithoutFrictionTheWayBackIsThatDown) {
  const lattice::StaticOutcome outcome = lattice::run_static_press(
      with_program({move(depth), hold(depth, 1.0), move(-0.1e-3), move(0.5e-3)},
                   ContactMode::frictionless, DriveMode::equilibrium));
  const auto& rows = outcome.response.samples();
  ASSERT_EQ(rows.size(), 4u + 4u + 2u);
  ASSERT_EQ(outcome.response.pressing().size(), 4u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(rows[4 + i].indentation, rows[2 - i].indentation);
    EXPECT_NEAR(rows[4 + i].normal_force, rows[2 - i].normal_force, 1e-6 * rows[3].normal_force);
    EXPECT_EQ(rows[4 + i].stage, 3.0);
  }
  EXPECT_NEAR(rows[7].normal_force, 0.0, 1e-9);
  EXPECT_EQ(rows[7].indentation, -0.1e-3);
  EXPECT_NEAR(rows[9].normal_force, rows[1].normal_force, 1e-6 * rows[3].normal_force);
}

TEST(StaticProgramPress, WhatLetsGoIsWhatTouchedLastSoStickingGivesAllBack) {
  // Without slip the points on the plane and their anchors are those of the same depth on the way
  // down: no loop.
  const lattice::StaticOutcome outcome = lattice::run_static_press(with_program(
      {move(depth), move(-0.1e-3), move(depth)}, ContactMode::stick, DriveMode::equilibrium));
  const auto& rows = outcome.response.samples();
  ASSERT_EQ(rows.size(), 4u + 4u + 4u);
  const double peak = rows[3].normal_force;
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(rows[4 + i].normal_force, rows[2 - i].normal_force, 1e-4 * peak);
  EXPECT_NEAR(rows[7].normal_force, 0.0, 1e-9);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(rows[8 + i].normal_force, rows[i].normal_force, 1e-3 * peak);
}
