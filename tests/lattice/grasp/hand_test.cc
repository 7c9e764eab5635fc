#include "lattice/grasp/hand.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace fingertip;
using lattice::Hand;
using lattice::HandSetup;
using lattice::Kinematics;
using lattice::ModelKind;
using meshes::Vector3;

namespace {

HandSetup coarse(ModelKind kind) {
  HandSetup setup;
  setup.finger.lattice.model = kind;
  setup.finger.lattice.kinematics =
      kind == ModelKind::network ? Kinematics::finite : Kinematics::small;
  setup.finger.lattice.spacing = 0.01 / 6;
  setup.finger.lattice.constants =
      lattice::hookean_constants(setup.finger.rubber, setup.finger.lattice.spacing);
  setup.finger.threads = 1;
  return setup;
}

struct Momenta {
  Vector3 linear = Vector3::Zero();
  Vector3 angular = Vector3::Zero();  // about the world's origin
};

/// Of rods, particles and block, summed afresh.
Momenta momenta(const Hand& hand) {
  const lattice::RodState& block = hand.block();
  Momenta sum{block.momentum(), block.centre().cross(block.momentum()) + block.angular_momentum()};
  for (std::size_t side = 0; side < 2; ++side) {
    const lattice::Finger& finger = hand.finger(side).finger();
    const lattice::LatticeModel& model = finger.model();
    Vector3 linear = finger.rod().momentum();
    Vector3 angular = finger.rod().centre().cross(linear) + finger.rod().angular_momentum();
    for (const std::uint32_t i : model.particles) {
      const Vector3 p = model.mass[i] * (model.grid.axes * finger.state().velocity.at(i));
      linear += p;
      angular += lattice::position(model, finger.state(), i).cross(p);
    }
    const lattice::Pose& base = hand.base(side);
    sum.linear += base.orientation * linear;
    sum.angular +=
        base.orientation * angular + base.position.cross(Vector3(base.orientation * linear));
  }
  return sum;
}

/// Two free fingers fly against a free, turning block, one faster than the other.
void expect_conservation(ModelKind kind, meshes::ContactMode contact, double angular_tolerance) {
  HandSetup setup = coarse(kind);
  setup.finger.contact.mode = contact;
  setup.gravity = 0.0;
  setup.supported = false;
  Hand hand(setup, 1e-3);
  hand.finger(0).finger().rod().set_velocity({0.02, 0.0, 0.15}, Vector3::Zero());
  hand.finger(1).finger().rod().set_velocity({0.0, 0.01, 0.05}, Vector3::Zero());
  hand.block().set_velocity(Vector3::Zero(), {1.0, 0.5, -0.5});
  const Momenta before = momenta(hand);
  double largest_push = 0.0;
  for (int n = 0; n < 400; ++n) {
    hand.advance();
    largest_push = std::max(largest_push, hand.on_block(0).force.norm());
  }
  const Momenta after = momenta(hand);
  ASSERT_GT(largest_push, 0.03);
  EXPECT_GT(std::abs(hand.block().velocity().x()), 1e-3);
  const double scale = hand.finger(0).rod_body().mass * 0.15;
  EXPECT_LT((after.linear - before.linear).norm(), 1e-12 * scale);
  EXPECT_LT((after.angular - before.angular).norm(), angular_tolerance * scale * 0.01);
}

}  // namespace

TEST(Hand, KeepsMomentumAndAngularMomentum) {
  // The network is objective: its forces twist nothing.
  expect_conservation(ModelKind::network, meshes::ContactMode::stick, 1e-10);
}

TEST(Hand, KeepsMomentumWithoutFriction) {
  // At small strain internal forces are balanced in the places at rest: moments to first order.
  expect_conservation(ModelKind::hookean, meshes::ContactMode::frictionless, 0.1);
}

TEST(Hand, FacesFollowTheBlock) {
  lattice::BlockSettings settings;
  settings.eccentricity = {0.001, 0.002, -0.003};
  lattice::RodState block(lattice::block_body(settings));
  block.set_velocity({0.3, -0.2, 0.1}, {4.0, 5.0, -6.0});
  lattice::Pose base;
  base.position = {-0.03, 0.01, 0.02};
  base.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Vector3(1, 2, 3).normalized()));
  const double step = 1e-6;
  for (const double side : lattice::sides) {
    const lattice::Plane start = lattice::face_plane(settings, block, side, base);
    EXPECT_NEAR((base * start.point).x(), 0.5 * side * settings.width, 1e-15);
    lattice::RodState moved = block;
    moved.drift(step);
    // What the plane foretells by its own velocities is where the block's face goes.
    const lattice::Plane foretold = start.after(step);
    const lattice::Plane true_plane = lattice::face_plane(settings, moved, side, base);
    const Vector3 mark = start.place({0.001, 0.004, 0.002});
    EXPECT_LT((foretold.place(start.fixed(mark)) - true_plane.place(start.fixed(mark))).norm(),
              1e-12);  // gyroscopic, step²
    EXPECT_LT((foretold.normal - true_plane.normal).norm(), 1e-9);
    EXPECT_LT(
        (start.velocity_at(mark) - (true_plane.place(start.fixed(mark)) - mark) / step).norm(),
        1e-5);
  }
}

TEST(Hand, RefusesABlockLighterThanTheRubberThatTouchesIt) {
  HandSetup setup = coarse(ModelKind::hookean);
  setup.block.mass = 1e-4;
  try {
    Hand hand(setup, 1e-3);
    FAIL() << "accepted";
  } catch (const meshes::InvalidInput& error) {
    EXPECT_EQ(error.violations().front().key, "grasp.block_mass");
    EXPECT_NE(error.violations().front().rule.find("outweigh"), std::string::npos);
  }
}

TEST(Hand, CouplingIsTheRatioOfMassesWhereNothingCanTurn) {
  // A block so long that its inertia is endless only moves straight: rho(M⁻¹ M_c) = m_c/M, the same
  // for every direction, so doubling M halves it.
  HandSetup setup = coarse(ModelKind::hookean);
  setup.block.height = 10.0;
  const double once = Hand(setup, 1e-3).coupling();
  setup.block.mass *= 2.0;
  EXPECT_NEAR(Hand(setup, 1e-3).coupling(), 0.5 * once, 1e-9 * once);
  EXPECT_GT(once, 0.0);
}
