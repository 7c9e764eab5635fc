// Presses of a lattice against other obstacles than a plane.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lattice/press/press.h"
#include "lattice/press/static_press.h"
#include "tests/lattice/presses.h"

using namespace fingertip;
using lattice::ModelKind;
using lattice::PressSetup;
using meshes::ContactMode;
using meshes::DriveMode;
using meshes::Obstacle;
using meshes::ObstacleAxis;
using meshes::ObstacleShape;

namespace {

PressSetup press_on(const Obstacle& obstacle, ModelKind model, ContactMode contact,
                    double per_radius = 6) {
  PressSetup setup = presses::setup_of(
      {.model = model, .per_radius = per_radius, .contact = contact, .samples = {0.75e-3, 1.5e-3}});
  setup.protocol.obstacle = obstacle;
  return setup;
}

std::vector<meshes::PressSample> pressed(const PressSetup& setup) {
  return lattice::run_static_press(setup).response.samples();
}

const std::vector<std::pair<ModelKind, ContactMode>> kinds = {
    {ModelKind::hookean, ContactMode::frictionless},
    {ModelKind::hookean, ContactMode::stick},
    {ModelKind::network, ContactMode::frictionless},
    {ModelKind::network, ContactMode::stick}};

TEST(ObstaclePress, ATurnedCylinderGivesTheSameForce) {
  for (const auto& [model, contact] : kinds) {
    for (const ObstacleShape shape : {ObstacleShape::cylinder, ObstacleShape::edge}) {
      Obstacle obstacle{.shape = shape, .radius = 2e-3};
      const auto along_y = pressed(press_on(obstacle, model, contact));
      obstacle.along = ObstacleAxis::x;
      const auto along_x = pressed(press_on(obstacle, model, contact));
      for (std::size_t i = 0; i < along_y.size(); ++i) {
        EXPECT_NEAR(along_x[i].normal_force, along_y[i].normal_force,
                    1e-6 * along_y[i].normal_force);
        EXPECT_NEAR(along_x[i].contact_radius, along_y[i].contact_radius, 1e-8);
      }
    }
  }
}

TEST(ObstaclePress, AnObstacleOnTheOtherSideGivesTheMirrorImage) {
  for (const auto& [model, contact] : kinds) {
    Obstacle obstacle{.shape = ObstacleShape::sphere, .radius = 4e-3, .offset = 3e-3};
    const auto right = pressed(press_on(obstacle, model, contact));
    obstacle.offset = -3e-3;
    const auto left = pressed(press_on(obstacle, model, contact));
    for (std::size_t i = 0; i < right.size(); ++i) {
      const double force = right[i].normal_force;
      EXPECT_NEAR(left[i].normal_force, force, 1e-6 * force);
      EXPECT_NEAR(left[i].lateral_force_x, -right[i].lateral_force_x, 1e-6 * force);
      EXPECT_NEAR(left[i].torque_y, -right[i].torque_y, 1e-6 * force * 0.03);
      // Beside the axis the tip leans on the ball; at small strain forces know one direction.
      if (model == ModelKind::network) {
        EXPECT_GT(std::abs(right[i].lateral_force_x), 0.02 * force);
      }
    }
  }
}

/// What is held along a ball's normal alone must not be heavy along its surface.
TEST(ObstaclePress, ScaledMassesSlideAlongABall) {
  const Obstacle ball{.shape = ObstacleShape::sphere, .radius = 8e-3, .offset = 1e-3};
  PressSetup setup = press_on(ball, ModelKind::network, ContactMode::frictionless);
  setup.protocol.samples = {1e-3, 2e-3};
  setup.protocol.depth = 2e-3;
  setup.protocol.mode = DriveMode::quasi_static;
  const auto plain = lattice::run_press(setup).response;
  setup.integrator = lattice::Integrator::mass_scaled;
  setup.time_step = 1e-3;
  const auto scaled = lattice::run_press(setup).response;
  ASSERT_EQ(scaled.samples().size(), plain.samples().size());
  double squares = 0.0, of_torque = 0.0;
  int compared = 0;
  for (std::size_t i = 0; i < plain.samples().size(); ++i) {
    const meshes::PressSample &as_is = plain.samples()[i], &heavy = scaled.samples()[i];
    if (as_is.indentation < 1e-3) continue;
    EXPECT_LT(as_is.lateral_force_x, 0.0);
    squares += std::pow(heavy.lateral_force_x / as_is.lateral_force_x - 1.0, 2);
    of_torque += std::pow(heavy.torque_y / as_is.torque_y - 1.0, 2);
    ++compared;
  }
  std::printf("lateral force off by %.3g in root mean square, torque by %.3g\n",
              std::sqrt(squares / compared), std::sqrt(of_torque / compared));
  EXPECT_LT(std::sqrt(squares / compared), 0.035);
  EXPECT_LT(std::sqrt(of_torque / compared), 0.035);
}

TEST(ObstaclePress, ALargeBallIsAPlane) {
  for (const auto& [model, contact] : {kinds.front(), kinds.back()}) {
    const auto flat = pressed(press_on({}, model, contact));
    const auto round =
        pressed(press_on({.shape = ObstacleShape::sphere, .radius = 10.0}, model, contact));
    for (std::size_t i = 0; i < flat.size(); ++i)
      EXPECT_NEAR(round[i].normal_force, flat[i].normal_force, 2e-3 * flat[i].normal_force);
  }
}

/// The rod's work is what rubber and contact store, whatever the path.
TEST(ObstaclePress, ForceIsTheSlopeOfTheEnergy) {
  for (const ObstacleShape shape :
       {ObstacleShape::sphere, ObstacleShape::cylinder, ObstacleShape::edge}) {
    PressSetup setup = press_on({.shape = shape, .radius = 2e-3, .offset = 1e-3},
                                ModelKind::network, ContactMode::frictionless);
    setup.protocol.mode = DriveMode::quasi_static;
    setup.protocol.samples = {setup.protocol.depth = 1e-3};
    setup.protocol.speed = 0.02;
    const lattice::PressOutcome outcome = lattice::run_press(setup);
    EXPECT_LT(outcome.momentum_defect, 1e-9);
    double work = 0.0;
    const auto& trace = outcome.trace;
    for (std::size_t i = 1; i < trace.size(); ++i)
      work += 0.5 * (trace[i].normal_force + trace[i - 1].normal_force) *
              (trace[i].indentation - trace[i - 1].indentation);
    // Damping takes what is left.
    EXPECT_NEAR(trace.back().elastic_energy + trace.back().kinetic_energy, work, 0.03 * work)
        << name(shape);
  }
}

TEST(ObstaclePress, MovesAsItRests) {
  for (const auto& [model, contact] : kinds) {
    for (const ObstacleShape shape : {ObstacleShape::sphere, ObstacleShape::edge}) {
      PressSetup setup = press_on({.shape = shape, .radius = 3e-3, .offset = 1e-3}, model, contact);
      setup.protocol.samples = {setup.protocol.depth = 1.5e-3};
      const double expected = pressed(setup).back().normal_force;
      setup.protocol.mode = DriveMode::quasi_static;
      const double found = lattice::run_press(setup).response.normal_force_at(1.5e-3);
      EXPECT_NEAR(found, expected, 0.03 * expected) << name(shape) << name(model);
    }
  }
}

TEST(ObstaclePress, PublishedParticlesStandOnTheObstacle) {
  for (const ContactMode contact : {ContactMode::stick, ContactMode::frictionless}) {
    PressSetup setup = press_on({.shape = ObstacleShape::sphere, .radius = 5e-3},
                                ModelKind::published, contact, 8);
    setup.protocol.samples = {setup.protocol.depth = 1e-3};
    const double at_rest = pressed(setup).back().normal_force;
    setup.protocol.mode = DriveMode::quasi_static;
    const auto outcome = lattice::run_press(setup);
    EXPECT_NEAR(outcome.response.normal_force_at(1e-3), at_rest, 0.1 * at_rest);
    EXPECT_LT(outcome.momentum_defect, 1e-9);
  }
}

/// A plane, a ball, a cylinder and an edge, pressed upon and then moved along their plane.
const std::vector<Obstacle> moved_obstacles = {{},
                                               {.shape = ObstacleShape::sphere, .radius = 6e-3},
                                               {.shape = ObstacleShape::cylinder, .radius = 6e-3},
                                               {.shape = ObstacleShape::edge, .radius = 2e-3}};
const std::vector<std::pair<ModelKind, ContactMode>> moved_kinds = {
    {ModelKind::hookean, ContactMode::frictionless},
    {ModelKind::hookean, ContactMode::stick},
    {ModelKind::hookean, ContactMode::coulomb},
    {ModelKind::network, ContactMode::stick},
    {ModelKind::network, ContactMode::coulomb}};

PressSetup moved_press(const Obstacle& obstacle, ModelKind model, ContactMode contact) {
  PressSetup setup = press_on(obstacle, model, contact, 5);
  setup.protocol.friction = 0.4;
  setup.protocol.samples = {setup.protocol.depth = 1.5e-3};
  setup.protocol.lateral_samples = 1;
  return setup;
}

std::string words_of(const Obstacle& obstacle, ModelKind model, ContactMode contact) {
  return std::string(name(obstacle.shape)) + ", " + std::string(name(model)) + ", " +
         std::string(name(contact));
}

/// What the field of the last sample adds up to is what the rod feels, by force and torque within
/// `share` of the normal force; nothing holds more across than friction does.
void expect_balance(const meshes::PressSample& sample, std::span<const meshes::ContactPoint> field,
                    const PressSetup& setup, double share) {
  const meshes::ContactSums sums = sums_of(field, setup.geometry.rod_endpoint());
  const double force = share * sample.normal_force, torque = force * setup.geometry.tip_radius;
  EXPECT_NEAR(-sums.force.z(), sample.normal_force, force);
  EXPECT_NEAR(sums.force.x(), sample.lateral_force_x, force);
  EXPECT_NEAR(sums.force.y(), sample.lateral_force_y, force);
  EXPECT_NEAR(sums.torque.x(), sample.torque_x, torque);
  EXPECT_NEAR(sums.torque.y(), sample.torque_y, torque);
  EXPECT_NEAR(sums.torque.z(), sample.torque_z, torque);
}

TEST(ObstaclePress, ContactAndRodFeelTheSameWhereTheObstacleMoves) {
  for (const Obstacle& obstacle : moved_obstacles) {
    for (const auto& [model, contact] : moved_kinds) {
      for (const bool twisted : {false, true}) {
        SCOPED_TRACE(words_of(obstacle, model, contact) + (twisted ? ", twisted" : ", aside"));
        PressSetup setup = moved_press(obstacle, model, contact);
        setup.protocol.lateral_path = meshes::LateralPath::after;
        (twisted ? setup.protocol.twist : setup.protocol.lateral) = twisted ? 0.17 : 3e-4;
        const auto outcome = lattice::run_static_press(setup);
        const auto fields = samples_of(outcome.contact);
        ASSERT_EQ(fields.size(), 2U);
        expect_balance(outcome.response.samples().back(), fields.back(), setup, 1e-6);
      }
    }
  }
}

/// A ball that sticks takes the rubber along: what it presses on stays as it is. (Told from where
/// the rubber is at rest, gaps would close in front of the ball: 4 % more force.)
TEST(ObstaclePress, SmallStrainFollowsTheObstacle) {
  for (const ContactMode contact : {ContactMode::stick, ContactMode::coulomb}) {
    std::vector<double> change;
    for (const ModelKind model : {ModelKind::hookean, ModelKind::network}) {
      PressSetup setup = moved_press(moved_obstacles[1], model, contact);
      setup.protocol.lateral_path = meshes::LateralPath::after;
      setup.protocol.lateral = 6e-4;
      const auto samples = pressed(setup);
      change.push_back(samples[1].normal_force / samples[0].normal_force - 1.0);
    }
    EXPECT_LT(std::abs(change[1]), 0.01);
    EXPECT_NEAR(change[0], change[1], 0.01) << name(contact);
  }
}

/// To one side, to the other and back: friction takes work and never gives any.
TEST(ObstaclePress, AClosedLoopTakesWork) {
  for (const Obstacle& obstacle : moved_obstacles) {
    for (const auto& [model, contact] : moved_kinds) {
      SCOPED_TRACE(words_of(obstacle, model, contact));
      PressSetup setup = moved_press(obstacle, model, contact);
      setup.protocol.friction = 0.1;
      setup.protocol.lateral_samples = 3;
      setup.protocol.program = {{.indentation = setup.protocol.depth, .speed = 1e-2}};
      for (const double place : {3e-4, -3e-4, 0.0, 3e-4})
        setup.protocol.program.push_back({.indentation = setup.protocol.depth,
                                          .speed = 1e-2,
                                          .move = meshes::StageMove::lateral,
                                          .lateral = place});
      const auto samples = pressed(setup);
      // The loop is that of the last three stages, from one side back to it.
      double work = 0.0;
      for (std::size_t i = 1; i < samples.size(); ++i) {
        if (samples[i].stage < 3.0) continue;
        work += 0.5 * (samples[i].lateral_force_x + samples[i - 1].lateral_force_x) *
                (samples[i].lateral_displacement - samples[i - 1].lateral_displacement);
      }
      const double scale = 0.1 * samples.back().normal_force * 1.2e-3;
      EXPECT_GE(work, -1e-3 * scale);
      if (contact == ContactMode::coulomb) {
        EXPECT_GT(work, 0.01 * scale);
      }
    }
  }
}

TEST(ObstaclePress, AMovingContactAndItsRodFeelTheSame) {
  for (const Obstacle& obstacle : moved_obstacles) {
    for (const ContactMode contact : {ContactMode::stick, ContactMode::coulomb}) {
      SCOPED_TRACE(words_of(obstacle, ModelKind::hookean, contact));
      PressSetup setup = moved_press(obstacle, ModelKind::hookean, contact);
      setup.protocol.lateral = 3e-4;  // on the way down
      const auto at_rest = pressed(setup).back();
      setup.protocol.mode = DriveMode::quasi_static;
      const auto outcome = lattice::run_press(setup);
      const auto fields = samples_of(outcome.contact);
      ASSERT_FALSE(fields.empty());
      const meshes::PressSample& sample = outcome.response.samples().back();
      expect_balance(sample, fields.back(), setup, 0.02);
      EXPECT_NEAR(sample.normal_force, at_rest.normal_force, 0.03 * at_rest.normal_force);
      EXPECT_NEAR(sample.lateral_force_x, at_rest.lateral_force_x, 0.03 * at_rest.normal_force);
    }
  }
}

}  // namespace
