// A plane that moves and tilts: the same as a rod that does, and nothing lost on the way.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "lattice/control/virtual_finger.h"
#include "lattice/forces/energy.h"
#include "lattice/press/press.h"
#include "lattice/press/static_press.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fixtures;
using lattice::ContactLaw;
using lattice::FingerSetup;
using lattice::Kinematics;
using lattice::ModelKind;
using lattice::Plane;
using lattice::PressSetup;
using lattice::VirtualFinger;
using lattice::Wrench;
using meshes::ContactMode;

namespace {

constexpr double depth = 1.5e-3, clearance = 0.5e-3, speed = 0.01;

PressSetup slow_press(const ContactLaw& law, double lateral) {
  PressSetup setup;
  setup.lattice = settings_for(ModelKind::hookean, Kinematics::small, 6);
  setup.protocol.mode = meshes::DriveMode::quasi_static;
  setup.protocol.contact = law.mode;
  setup.protocol.friction = law.friction;
  setup.protocol.lateral = lateral;
  setup.protocol.depth = depth;
  setup.protocol.speed = speed;
  setup.threads = 1;
  return setup;
}

/// The same specimen on a rod at rest, the plane where the press has it.
FingerSetup held_finger(const PressSetup& press) {
  FingerSetup setup;
  setup.lattice = press.lattice;
  setup.contact = {press.protocol.contact, press.protocol.friction};
  setup.plane = {Vector3(0.0, 0.0, 0.01 + clearance), -Vector3::UnitZ()};
  setup.prescribed = true;
  setup.threads = 1;
  return setup;
}

std::unique_ptr<VirtualFinger> held(const PressSetup& press) {
  auto finger = std::make_unique<VirtualFinger>(held_finger(press));
  finger->write([](double) { return lattice::RodMotion{}; });
  return finger;
}

void move_plane(VirtualFinger& finger, const Vector3& velocity,
                const Vector3& turning = {0, 0, 0}) {
  Plane plane = finger.finger().plane();
  plane.velocity = velocity;
  plane.angular_velocity = turning;
  finger.move_plane(plane);
}

/// Momentum and, about the world's origin, angular momentum of particles and rod.
Wrench momenta(const lattice::Finger& finger) {
  const lattice::LatticeModel& model = finger.model();
  const lattice::RodState& rod = finger.rod();
  Wrench sum{rod.momentum(), rod.angular_momentum() + rod.centre().cross(rod.momentum())};
  for (const std::uint32_t i : model.particles) {
    const Vector3 p = model.mass[i] * (model.grid.axes * finger.state().velocity.at(i));
    sum.force += p;
    sum.torque += position(model, finger.state(), i).cross(p);
  }
  return sum;
}

}  // namespace

TEST(MovingPlane, GivesTheForceOfTheRodThatMovesInstead) {
  // Galilei: to the rod a plane that comes nearer and laterally is the press with that lateral
  // motion.
  for (const ContactLaw& law :
       {ContactLaw{ContactMode::frictionless}, ContactLaw{ContactMode::stick},
        ContactLaw{ContactMode::coulomb, 0.3}}) {
    const PressSetup setup = slow_press(law, 1e-3);
    const meshes::PressSample expected = lattice::run_press(setup).response.samples().back();
    const auto finger = held(setup);
    move_plane(*finger, speed * Vector3(1e-3 / depth, 0.0, -1.0));
    finger->do_step((clearance + depth) / speed);
    const Wrench bond = finger->finger().bond();
    const double force = expected.normal_force;
    EXPECT_NEAR(-bond.force.z(), force, 0.005 * force) << name(law.mode);
    EXPECT_NEAR(bond.force.x(), expected.lateral_force_x, 0.005 * force) << name(law.mode);
    EXPECT_NEAR(bond.force.y(), 0.0, 0.005 * force) << name(law.mode);
    EXPECT_NEAR(bond.torque.y(), expected.torque_y, 0.005 * force * 0.04) << name(law.mode);
    EXPECT_EQ(std::abs(bond.force.x()) > 0.1 * force, law.mode != ContactMode::frictionless);
  }
}

TEST(MovingPlane, TiltsTheLoadAsThePressOfATiltedTip) {
  // Without friction the equilibrium knows nothing of the way: pressed straight, then tilted, it
  // is the press that was tilted from the start.
  PressSetup setup = slow_press(ContactMode::frictionless, 0.0);
  const auto finger = held(setup);
  move_plane(*finger, -0.02 * Vector3::UnitZ());
  finger->do_step((clearance + depth) / 0.02);
  const double tilt = std::numbers::pi / 18.0;
  const int parts = 100;
  for (int n = 1; n <= parts; ++n) {
    const double angle = tilt * n / parts, duration = 1e-3;
    const Vector3 there = (depth - 0.01) * Vector3(-std::sin(angle), 0.0, -std::cos(angle));
    move_plane(*finger, (there - finger->finger().plane().point) / duration,
               Vector3(0.0, tilt / parts / duration, 0.0));
    finger->do_step(duration);
  }
  move_plane(*finger, Vector3::Zero());
  finger->do_step(0.05);
  setup.protocol.tilt = tilt;
  const Vector3 normal = lattice::press_plane(setup.protocol, {}).normal;
  EXPECT_LT((finger->finger().plane().normal - normal).norm(), 1e-12);
  const meshes::PressSample expected = lattice::run_static_press(setup).response.samples().back();
  const Wrench bond = finger->finger().bond();
  const double force = expected.normal_force;
  EXPECT_NEAR(bond.force.dot(normal), force, 0.005 * force);
  EXPECT_NEAR(bond.torque.y(), expected.torque_y, 0.005 * force * 0.04);
  EXPECT_LT((bond.force - bond.force.dot(normal) * normal).norm(), 0.005 * force);
  EXPECT_GT(std::abs(expected.torque_y), 0.05 * force * 0.04);
}

TEST(MovingPlane, BalancesMomentumAndAngularMomentumUnderGravity) {
  // At finite strain internal forces have no moment whatever the state; so what rod and particles
  // have is what the hand, gravity and the plane gave, while the plane moves, tilts and drags.
  for (const ModelKind kind : {ModelKind::network, ModelKind::published}) {
    for (const ContactLaw& law :
         {ContactLaw{ContactMode::frictionless}, ContactLaw{ContactMode::stick},
          ContactLaw{ContactMode::coulomb, 0.4}}) {
      FingerSetup setup;
      setup.lattice = settings_for(kind, Kinematics::finite, 5);
      setup.contact = law;
      setup.plane = {Vector3(0.0, 0.0, 0.0101), Vector3(-0.1, 0.0, -1.0).normalized()};
      setup.gravity = {1.0, 0.7, 3.0};
      setup.threads = 1;
      VirtualFinger finger(setup);
      finger.finger().rod().set_velocity({0.01, 0.005, 0.02}, {0.2, 0.1, 0.5});
      move_plane(finger, {0.03, -0.02, -0.02}, {0.5, 1.0, 0.2});
      const Wrench push{Vector3(0.01, 0.02, 0.05), Vector3(1e-5, 2e-5, 0.0)};
      const lattice::LatticeModel& model = finger.model();
      const double step = finger.finger().step();
      const Wrench start = momenta(finger.finger());
      Wrench given, plane;
      int touching = 0, sliding = 0;
      for (int n = 0; n < 2000 && touching < 150; ++n) {
        const lattice::RodState& rod = finger.finger().rod();
        Vector3 moment = rod.body().mass * rod.centre();
        for (const std::uint32_t i : model.particles) {
          moment += model.mass[i] * position(model, finger.finger().state(), i);
        }
        const double mass = rod.body().mass + model.total_mass();
        given.force += step * (push.force + mass * setup.gravity);
        given.torque +=
            step * (push.torque + rod.endpoint().cross(push.force) + moment.cross(setup.gravity));
        finger.finger().advance(push);
        plane.force += finger.finger().plane_impulse().force;
        plane.torque += finger.finger().plane_impulse().torque;
        touching += finger.finger().touching() > 0;
        sliding += finger.finger().sliding() > 0;
      }
      const Wrench end = momenta(finger.finger());
      const std::string what = label(kind, Kinematics::finite) + " " + std::string(name(law.mode));
      EXPECT_EQ(touching, 150) << what;
      EXPECT_EQ(sliding > 0, law.mode == ContactMode::coulomb) << what;
      EXPECT_LT((end.force - start.force - given.force - plane.force).norm(),
                1e-10 * plane.force.norm())
          << what;
      EXPECT_LT((end.torque - start.torque - given.torque - plane.torque).norm(),
                1e-10 * plane.torque.norm())
          << what;
    }
  }
}
