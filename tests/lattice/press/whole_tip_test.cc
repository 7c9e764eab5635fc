#include "lattice/press/whole_tip.h"

#include <gtest/gtest.h>

#include "lattice/control/virtual_finger.h"
#include "lattice/model/cut_model.h"
#include "lattice/press/press_task.h"
#include "tests/coarse_press.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using lattice::PressSetup;
using lattice::VirtualFinger;
using lattice::WholeTip;
using meshes::Vector3;

namespace {

/// R/n of a press to 1 mm that the rod is moved through.
PressSetup prescribed(int n, meshes::ContactMode contact) {
  PressSetup setup = coarse_press();
  setup.lattice.spacing = setup.geometry.tip_radius / n;
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  setup.protocol.mode = meshes::DriveMode::quasi_static;
  setup.protocol.contact = contact;
  return setup;
}

std::unique_ptr<VirtualFinger> finger_of(const PressSetup& setup, int sectors) {
  const lattice::PressWay way(setup.protocol, setup.geometry);
  lattice::FingerSetup finger = lattice::finger_setup(setup, way);
  finger.sectors = sectors;
  auto result = std::make_unique<VirtualFinger>(finger);
  result->write([way, motion = meshes::PressMotion(setup.protocol)](double time) {
    const meshes::SetPoint point = motion.at(time);
    return lattice::RodMotion{point.distance * way.direction, point.speed * way.direction};
  });
  return result;
}

double force_after(VirtualFinger& finger, double duration) {
  finger.do_step(duration);
  return -finger.finger().bond().force.z();
}

}  // namespace

TEST(WholeTip, ALinearStateIsCarriedOverExactlyToAnyGrid) {
  const PressSetup setup = prescribed(6, meshes::ContactMode::stick);
  const lattice::LatticeModel from = lattice::build_tip({}, {}, setup.lattice);
  Eigen::Matrix3d gradient;
  gradient << 0.1, -0.02, 0.03, 0.04, -0.2, 0.01, 0.05, 0.06, 0.15;
  const Vector3 shift(1e-3, -2e-3, 3e-3);
  const auto wanted = [&](const Vector3& rest) -> Vector3 { return gradient * rest + shift; };
  lattice::State state(from);
  for (const std::uint32_t i : from.particles) {
    const Vector3 moved = from.grid.axes.transpose() * wanted(from.rest_position(i));
    state.displacement.set(i, moved);
    state.velocity.set(i, 10.0 * moved);
  }
  lattice::LatticeSettings other = prescribed(4, meshes::ContactMode::stick).lattice;
  other.axes = lattice::rotation_by({0.2, -0.4, 0.7}).toRotationMatrix();
  const lattice::LatticeModel to = lattice::build_tip({}, {}, other);
  const lattice::State carried = lattice::carried_over(from, state, to);
  for (const std::uint32_t i : to.particles) {
    const Vector3 there = to.grid.axes.transpose() * wanted(to.rest_position(i));
    EXPECT_LT((carried.displacement.at(i) - there).norm(), 1e-11);
    EXPECT_LT((carried.velocity.at(i) - 10.0 * there).norm(), 1e-10);
  }
}

TEST(WholeTip, AQuarterGoesOnAsTheWhole) {
  for (const auto contact : {meshes::ContactMode::frictionless, meshes::ContactMode::stick}) {
    const PressSetup setup = prescribed(5, contact);
    const auto quarter = finger_of(setup, 4), whole = finger_of(setup, 1),
               other = finger_of(setup, 1);
    const double before = force_after(*quarter, 0.03);
    EXPECT_NEAR(force_after(*whole, 0.03), before, 1e-8 * before);
    const WholeTip tip(setup, quarter->model());
    other->take_over(*quarter, tip.state_of(quarter->model(), quarter->finger().state()));
    EXPECT_EQ(other->time(), quarter->time());
    // Anchored anew, what sticks has to be stretched again, by a part of the indentation.
    const double allowed = contact == meshes::ContactMode::stick ? 5e-3 : 1e-8;
    for (int i = 0; i < 5; ++i) {
      const double force = force_after(*whole, 1e-3);
      EXPECT_NEAR(force_after(*other, 1e-3), force, allowed * force) << i;
    }
  }
}

TEST(WholeTip, ACoarserLatticeGoesOnWhereAFinerOneWas) {
  for (const auto contact : {meshes::ContactMode::frictionless, meshes::ContactMode::stick})
    for (const int sectors : {1, 4}) {
      const PressSetup fine = prescribed(8, contact), coarse = prescribed(6, contact);
      const auto first = finger_of(fine, sectors), next = finger_of(coarse, sectors),
                 alone = finger_of(coarse, sectors);
      force_after(*first, 0.2);  // the rubber sways on its rod for a while
      force_after(*alone, 0.2);
      const WholeTip tip(fine, first->model());
      next->take_over(
          *first,
          lattice::carried_over(tip.model(), tip.state_of(first->model(), first->finger().state()),
                                next->model()));
      const double force = force_after(*alone, 0.05);
      const double allowed = contact == meshes::ContactMode::stick ? 0.01 : 1e-3;
      EXPECT_NEAR(force_after(*next, 0.05), force, allowed * force) << int(contact) << sectors;
    }
}
