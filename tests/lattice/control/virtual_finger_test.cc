#include "lattice/control/virtual_finger.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/lattice/finger_scenes.h"

using namespace fingertip;
using namespace fixtures;
using lattice::RodMotion;
using lattice::VirtualFinger;
using lattice::Wrench;

namespace {

/// Pushed into the plane by 0.3 N for 25 ms: deep in contact, and moving.
void push_into_contact(VirtualFinger& finger) {
  finger.write(Wrench{Vector3(0.01, 0.0, 0.3), Vector3(0.0, 1e-5, 0.0)});
  finger.do_step(0.025);
  ASSERT_GT(finger.finger().touching(), 0);
}

/// Mass [kg] and centre of mass [m] of the particles at rest.
std::pair<double, Vector3> tip_mass(const lattice::LatticeModel& model) {
  Vector3 moment = Vector3::Zero();
  for (const std::uint32_t i : model.particles) moment += model.mass[i] * model.rest_position(i);
  return {model.total_mass(), moment / model.total_mass()};
}

}  // namespace

TEST(VirtualFinger, GoesOnFromASavedStateWithTheSameBits) {
  for (const auto mode : {meshes::ContactMode::stick, meshes::ContactMode::frictionless}) {
    lattice::FingerSetup setup = coarse_finger(0.1e-3);
    setup.contact = mode;
    VirtualFinger finger(setup), twin(setup);
    push_into_contact(finger);
    push_into_contact(twin);
    const VirtualFinger::Snapshot saved = finger.save();
    finger.do_step(0.01);
    finger.write(Wrench{});
    finger.do_step(0.02);  // another way, out of contact perhaps
    finger.load(saved);    // with the wrench that acted then
    EXPECT_TRUE(same_bits(finger, twin));
    finger.do_step(0.01);
    twin.do_step(0.01);
    EXPECT_TRUE(same_bits(finger, twin));
  }
}

/// Of a wrench and a rod's motion what is its own mirror image is as of the whole tip, the rest
/// held.
TEST(VirtualFinger, OfAPartKeepsToItsMirrorPlanes) {
  lattice::FingerSetup setup = coarse_finger(0.1e-3);
  setup.time_step = 5e-5;
  const Wrench all{Vector3(0.01, 0.02, 0.3), Vector3(2e-5, 1e-5, 3e-5)};
  const auto pushed = [&](int sectors, const Wrench& wrench) {
    setup.sectors = sectors;
    VirtualFinger finger(setup);
    finger.write(wrench);
    finger.do_step(0.025);
    EXPECT_GT(finger.finger().touching(), 0);
    EXPECT_LT(finger.finger().momentum_defect(), 1e-12 * finger.finger().largest_impulse());
    return finger.read();
  };
  const Wrench of_half{Vector3(0.01, 0.0, 0.3), Vector3(0.0, 1e-5, 0.0)},
      of_quarter{Vector3(0.0, 0.0, 0.3), Vector3::Zero()};
  for (const auto& [sectors, even] : {std::pair(2, of_half), std::pair(4, of_quarter)}) {
    const lattice::Measurement part = pushed(sectors, all), whole = pushed(1, even);
    SCOPED_TRACE(sectors);
    EXPECT_GT((whole.pose.position - setup.geometry.rod_endpoint()).norm(), 1e-4);
    EXPECT_LT((part.pose.position - whole.pose.position).norm(), 1e-12);
    EXPECT_LT((part.pose.orientation.inverse() * whole.pose.orientation).vec().norm(), 1e-10);
    EXPECT_LT((part.wrench.force - whole.wrench.force).norm(), 1e-9 * whole.wrench.force.norm());
    EXPECT_LT((part.wrench.torque - whole.wrench.torque).norm(), 1e-9 * 0.01 * 0.3);
    EXPECT_EQ(part.contact->touching, whole.contact->touching);
  }
}

/// Dense taxels feel the plane's force, those of a part what those of the whole finger feel.
TEST(VirtualFinger, ASkinFeelsThePlane) {
  lattice::FingerSetup setup = coarse_finger(0.1e-3);
  setup.time_step = 5e-5;
  const auto shape = meshes::shape_of(setup.geometry);
  setup.skin.taxels = meshes::taxel_rings(*shape, 26, 32, 0.5e-3);
  setup.skin.footprint = 1e-3;
  const auto pushed = [&](int sectors) {
    setup.sectors = sectors;
    VirtualFinger finger(setup);
    EXPECT_EQ(finger.read().taxels.at(0).normal_stress, 0.0);
    finger.write(Wrench{Vector3(0.0, 0.0, 0.3), Vector3::Zero()});
    finger.do_step(0.025);
    return finger.read();
  };
  const lattice::Measurement whole = pushed(1), part = pushed(4);
  ASSERT_EQ(whole.taxels.size(), setup.skin.taxels.size());
  double force = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < whole.taxels.size(); ++i) {
    force += setup.skin.taxels[i].area * whole.taxels[i].normal_stress;
    largest = std::max(largest, whole.taxels[i].normal_stress);
  }
  EXPECT_NEAR(force / -whole.contact->on_tip.force.z(), 1.0, 0.01);
  for (std::size_t i = 0; i < whole.taxels.size(); ++i)
    EXPECT_NEAR(part.taxels[i].normal_stress, whole.taxels[i].normal_stress, 1e-6 * largest) << i;
}

TEST(VirtualFinger, ResetIsAsBuilt) {
  const lattice::FingerSetup setup = coarse_finger(0.1e-3);
  VirtualFinger finger(setup), fresh(setup);
  push_into_contact(finger);
  finger.reset();
  EXPECT_TRUE(same_bits(finger, fresh));
  push_into_contact(finger);
  push_into_contact(fresh);
  EXPECT_TRUE(same_bits(finger, fresh));
}

TEST(VirtualFinger, APrescribedRodRestsUntilItIsTold) {
  lattice::FingerSetup setup = coarse_finger(1.0);
  setup.prescribed = true;
  VirtualFinger finger(setup);
  finger.do_step(1e-3);
  EXPECT_EQ(finger.read().pose.position, finger.rod_body().endpoint);
  finger.write([](double time) { return RodMotion{time * Vector3::UnitX(), Vector3::UnitX()}; });
  finger.do_step(1e-3);
  EXPECT_NEAR(finger.read().pose.position.x(), 2e-3, 1e-15);
  finger.reset();
  finger.do_step(1e-3);
  EXPECT_EQ(finger.read().pose.position, finger.rod_body().endpoint);
}

TEST(VirtualFinger, AStepInTwoPartsIsTheSameButForTheStepSize) {
  const lattice::FingerSetup setup = coarse_finger(0.1e-3);
  VirtualFinger whole(setup), parts(setup);
  push_into_contact(whole);
  push_into_contact(parts);
  whole.do_step(0.005);
  parts.do_step(0.0021);
  parts.do_step(0.0029);
  EXPECT_NEAR(whole.time(), parts.time(), 1e-12);
  const Vector3 in_one_step = whole.read().pose.position, in_parts = parts.read().pose.position;
  const double travel = (in_one_step - whole.rod_body().endpoint).norm();
  EXPECT_LT((in_one_step - in_parts).norm(), 1e-3 * travel);
  EXPECT_GT(travel, 0.5e-3);
}

TEST(VirtualFinger, AnObserverEndsAStepEarly) {
  VirtualFinger finger(coarse_finger(1.0)), whole(coarse_finger(1.0));
  const Wrench push{Vector3(0.0, 0.0, 0.1), Vector3::Zero()};
  finger.write(push);
  whole.write(push);
  int steps = 0;
  EXPECT_FALSE(finger.do_step(1e-3, [&] { return ++steps < 3; }));
  EXPECT_EQ(steps, 3);
  EXPECT_NEAR(finger.time(), 3.0 * finger.finger().step(), 1e-18);
  EXPECT_TRUE(finger.do_step(1e-3 - finger.time(), [&] { return ++steps > 0; }));
  EXPECT_TRUE(whole.do_step(1e-3));
  EXPECT_NEAR(finger.time(), 1e-3, 1e-15);
  EXPECT_NEAR(finger.read().pose.position.z(), whole.read().pose.position.z(), 1e-15);
}

TEST(VirtualFinger, InputsHoldUntilTheNext) {
  VirtualFinger finger(coarse_finger(1.0));
  finger.write(Wrench{Vector3(0.02, 0.0, 0.1), Vector3::Zero()});
  finger.do_step(1e-3);
  finger.do_step(2e-3);
  EXPECT_LT((momentum(finger) - 3e-3 * Vector3(0.02, 0.0, 0.1)).norm(), 1e-15);
  finger.write(Wrench{});
  finger.do_step(2e-3);
  EXPECT_LT((momentum(finger) - 3e-3 * Vector3(0.02, 0.0, 0.1)).norm(), 1e-15);
}

// Galilei: a finger at rest met by a moving plane is a moving finger that meets a resting plane.
TEST(VirtualFinger, APlaneThatComesIsLikeAFingerThatGoes) {
  static constexpr double speed = 0.02;
  constexpr double duration = 0.02;
  for (const auto mode : {meshes::ContactMode::stick, meshes::ContactMode::frictionless}) {
    lattice::FingerSetup setup = coarse_finger(0.1e-3);
    setup.contact = mode;
    setup.prescribed = true;
    VirtualFinger goes(setup), rests(setup);
    goes.write([](double time) {
      return RodMotion{speed * time * Vector3::UnitZ(), speed * Vector3::UnitZ()};
    });
    for (const std::uint32_t i : goes.model().particles) {
      goes.finger().state().velocity.set(
          i, goes.model().grid.axes.transpose() * (speed * Vector3::UnitZ()));
    }
    goes.finger().rod().prescribe(Vector3::Zero(), speed * Vector3::UnitZ());
    rests.write([](double) { return RodMotion{}; });
    lattice::Plane plane = setup.plane;
    plane.velocity = -speed * Vector3::UnitZ();
    rests.move_plane(plane);
    goes.do_step(duration);
    rests.do_step(duration);
    EXPECT_NEAR(rests.finger().plane().point.z(), setup.plane.point.z() - speed * duration, 1e-12);
    const double force = goes.read().wrench.force.z();
    EXPECT_LT(force, -1e-3);
    EXPECT_EQ(rests.finger().touching(), goes.finger().touching());
    EXPECT_NEAR(rests.read().wrench.force.z(), force, 1e-9 * std::abs(force));
    EXPECT_NEAR(rests.read().contact->on_tip.force.z(), goes.read().contact->on_tip.force.z(),
                1e-9 * std::abs(force));
  }
}

// The ties of the bond act as they will be at the end of a step, for which the rod's own
// acceleration is not known: they lag behind by some g h², and nothing else keeps the parts of a
// falling finger from moving as one.
TEST(VirtualFinger, FallsFreelyAsAWhole) {
  lattice::FingerSetup setup = coarse_finger(1.0);
  setup.gravity = Vector3(1.0, -2.0, -9.0);
  double last = 0.0;
  for (const double step : {1.5e-4, 0.75e-4}) {
    setup.time_step = step;
    VirtualFinger finger(setup);
    finger.do_step(0.05);
    // Symplectic Euler with step h from rest: x = g t (t + h)/2 exactly, v = g t.
    const double t = finger.time(), h = finger.finger().step();
    const double mass = finger.model().total_mass() + finger.rod_body().mass;
    EXPECT_LT((momentum(finger) - mass * t * setup.gravity).norm(), 1e-12 * mass * t);
    const Vector3 fallen = 0.5 * t * (t + h) * setup.gravity;
    const Vector3 travel = finger.read().pose.position - finger.rod_body().endpoint;
    double error = (travel - fallen).norm();
    for (const std::uint32_t i : finger.model().particles) {
      error = std::max(
          error,
          (finger.model().grid.axes * finger.finger().state().displacement.at(i) - fallen).norm());
    }
    EXPECT_LT(error, 4.0 * h * h * setup.gravity.norm());
    if (last > 0.0) {
      EXPECT_LT(error, 0.3 * last);  // at least second order
    }
    last = error;
  }
}

TEST(VirtualFinger, HeldItCarriesItsWeight) {
  lattice::FingerSetup setup = coarse_finger(1.0);
  setup.prescribed = true;
  setup.rubber.retardation_time = 2e-3;  // comes to rest soon
  for (const Vector3& gravity : {Vector3(0.0, 0.0, -9.81), Vector3(9.81, 0.0, 0.0)}) {
    setup.gravity = gravity;
    VirtualFinger finger(setup);
    finger.write([](double) { return RodMotion{}; });
    finger.do_step(0.15);
    const auto [mass, centre] = tip_mass(finger.model());
    const Vector3 arm = centre - finger.rod_body().endpoint;
    const lattice::Measurement m = finger.read();
    EXPECT_LT((m.wrench.force - mass * gravity).norm(), 1e-6 * mass * gravity.norm());
    EXPECT_LT((m.wrench.torque - arm.cross(mass * gravity)).norm(),
              1e-6 * mass * gravity.norm() * arm.norm());
  }
}
