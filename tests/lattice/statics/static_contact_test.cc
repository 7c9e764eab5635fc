/// Contact and equilibrium on blocks with known solutions.
#include "lattice/statics/static_contact.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "body_sums.h"
#include "lattice/statics/cut_lattice.h"
#include "lattice/statics/equilibrium.h"

using namespace fingertip;
using namespace body_sums;
using lattice::ElasticSystem;
using lattice::EquilibriumSolver;
using lattice::Kinematics;
using lattice::ModelKind;
using lattice::StaticContact;
using meshes::ContactMode;

namespace {

constexpr double spacing = 1e-3;
constexpr double height = 3e-3, width = 2e-3;

/// A block 2 x 2 x 3 cells that stands on z = 0 and cannot bulge, with ties of stiffness `tie`
/// [Pa/m] on its top, one in the middle of every cell's face.
LatticeBody confined_block(ModelKind model, Kinematics kinematics, double tie) {
  lattice::LatticeSettings settings;
  settings.model = model;
  settings.kinematics = kinematics;
  settings.spacing = spacing;
  const meshes::Rubber rubber;
  settings.constants =
      lattice::hookean_constants(rubber, spacing, 0.2 * spacing * rubber.shear_modulus);
  LatticeBody body = build_free_block(rubber, settings, {2, 2, 3});
  body.fixed.assign(std::size_t(body.unknowns()), 1);
  for (std::size_t p = 0; p < body.rest.size(); ++p)
    if (body.rest[p].z() > 0.5 * spacing) body.fixed[3 * p + 2] = 0;
  for (const MeanCell& cell : body.cells) {
    EmbeddedPoint point{cell.corners,      {},
                        Vector3::Zero(),   Vector3::UnitZ(),
                        spacing * spacing, tie * spacing * spacing};
    int top = 0;
    for (std::size_t c = 0; c < 8; ++c) {
      if (body.rest[cell.corners[c]].z() < height - 0.5 * spacing) continue;
      point.weights[c] = 0.25;
      point.rest += 0.25 * body.rest[cell.corners[c]];
      ++top;
    }
    if (top == 4) body.outer.push_back(point);
  }
  return body;
}

lattice::PressPlane plane_above(double distance) {
  lattice::PressPlane plane;
  plane.height = distance;
  return plane;
}

}  // namespace

/// The block and its ties are springs in series; law A's uniaxial strain is known in closed form.
TEST(Equilibrium, ConfinedBlockIsCompressedUniformly) {
  const meshes::Rubber rubber;
  const double M = rubber.longitudinal_modulus(), tie = 20.0 * M / spacing, depth = 4e-4;
  const double G = rubber.shear_modulus, lambda = rubber.lame_lambda();
  for (const auto& [model, kinematics] : {std::pair{ModelKind::hookean, Kinematics::small},
                                          {ModelKind::network, Kinematics::small},
                                          {ModelKind::network, Kinematics::finite}}) {
    SCOPED_TRACE(std::string(name(model)) + ", " + std::string(name(kinematics)));
    const LatticeBody body = confined_block(model, kinematics, tie);
    ASSERT_EQ(body.outer.size(), 4U);
    const ElasticSystem system(body);
    EquilibriumSolver solver(system);
    StaticContact contact(body, plane_above(height), ContactMode::frictionless);
    VectorXd u = VectorXd::Zero(body.unknowns());
    contact.begin_step(depth, u);
    ASSERT_TRUE(solver.solve(contact, u));
    const auto stress = [&](double stretch) {
      return kinematics == Kinematics::finite
                 ? G * (stretch - 1.0 / stretch) + lambda * std::log(stretch) / stretch
                 : M * (stretch - 1.0);
    };
    double low = 0.5, high = 1.0;  // stretch at which ties and block bear the same
    for (int i = 0; i < 60; ++i) {
      const double stretch = 0.5 * (low + high);
      const double penetration = height * stretch - (height - depth);
      (tie * penetration > -stress(stretch) ? high : low) = stretch;
    }
    EXPECT_NEAR(contact.reaction(u, Vector3::Zero()).force.z(), stress(low) * width * width,
                1e-9 * M * width * width);
    for (std::uint32_t p = 0; p < body.rest.size(); ++p) {
      const Vector3 expected(0.0, 0.0, (low - 1.0) * body.rest[p].z());
      EXPECT_LT((at(u, p) - expected).norm(), 1e-9 * height);
    }
  }
}

TEST(Equilibrium, WithoutContactRestIsKept) {
  const LatticeBody body = confined_block(ModelKind::network, Kinematics::finite, 1e8);
  const ElasticSystem system(body);
  EquilibriumSolver solver(system);
  StaticContact contact(body, plane_above(height + 1e-4), ContactMode::frictionless);
  VectorXd u = VectorXd::Zero(body.unknowns());
  contact.begin_step(5e-5, u);
  EXPECT_TRUE(solver.solve(contact, u));
  EXPECT_EQ(u.norm(), 0.0);
}

namespace {

void expect_derivatives(const LatticeBody& body, const lattice::PressPlane& plane) {
  const ElasticSystem system(body);
  for (const ContactMode mode : {ContactMode::frictionless, ContactMode::stick}) {
    StaticContact contact(body, plane, mode);
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const VectorXd u =
        VectorXd::NullaryExpr(body.unknowns(), [&] { return 1e-4 * uniform(generator); });
    const VectorXd d = VectorXd::NullaryExpr(body.unknowns(), [&] { return uniform(generator); });
    const VectorXd rest = VectorXd::Zero(body.unknowns());
    contact.anchor_touching(rest, 0.0, rest);
    const auto force_at = [&](const VectorXd& place) {
      VectorXd force = rest;
      contact.add(place, system, force, nullptr);
      return force;
    };
    const double step = 1e-7;
    const double slope = (contact.energy(u + step * d) - contact.energy(u - step * d)) / (2 * step);
    ASSERT_GT(contact.energy(u), 0.0);
    EXPECT_NEAR(-force_at(u).dot(d), slope, 1e-6 * std::abs(slope)) << name(mode);
    lattice::Tangent tangent = system.empty_tangent();
    VectorXd force = rest;
    contact.add(u, system, force, &tangent);
    const VectorXd change = (force_at(u - step * d) - force_at(u + step * d)) / (2 * step);
    EXPECT_LT((tangent.selfadjointView<Eigen::Lower>() * d - change).norm(), 1e-6 * change.norm())
        << name(mode);
  }
}

}  // namespace

TEST(StaticContact, ForceAndTangentAreDerivatives) {
  meshes::PressProtocol protocol;
  protocol.tilt = 0.3;
  meshes::Geometry geometry;
  geometry.tip_radius = 2.2e-3;
  geometry.rod_radius = 1e-3;
  LatticeBody body = confined_block(ModelKind::hookean, Kinematics::small, 1e8);
  expect_derivatives(body, lattice::press_plane(protocol, geometry));
  // Ties that stiffen: all points before the end of that, and some of them beyond.
  body = confined_block(ModelKind::network, Kinematics::finite, 1e8);
  for (const double limit : {1.0, 4e-4}) {
    body.contact = {1e7, limit};
    for (const auto shape : {meshes::ObstacleShape::plane, meshes::ObstacleShape::sphere}) {
      protocol.obstacle = {.shape = shape, .radius = 5e-3};
      expect_derivatives(body, lattice::press_plane(protocol, geometry));
    }
  }
}

/// A point that comes down and along reaches the plane at the share of the way at which its gap
/// closes; its anchor then moves with the plane, and it is freed when pulled.
TEST(StaticContact, SticksWhereItFirstTouched) {
  const LatticeBody body = confined_block(ModelKind::hookean, Kinematics::small, 1e8);
  lattice::PressPlane plane = plane_above(height);
  meshes::PressProtocol protocol;
  protocol.lateral = 0.5 * protocol.depth;
  plane.path = meshes::PressPath(protocol);
  StaticContact contact(body, plane, ContactMode::stick);
  const auto moved = [&](const Vector3& by) {
    return on_particles(body, [&](const Vector3&) -> Vector3 { return by; });
  };
  const double from = 1e-5, to = 5e-5;
  // Gap 3e-5 at the start, -1e-5 at the end: three quarters of the way. The plane moves by 2e-5.
  const VectorXd start = moved({0.0, 0.0, -4e-5}), end = moved({8e-5, -4e-5, -4e-5});
  contact.begin_step(to, start);
  EXPECT_EQ(contact.anchor_touching(start, from, end), 4);
  EXPECT_EQ(contact.anchor_touching(start, from, end), 0);
  const double stiffness = body.outer[0].stiffness;
  const double place = 0.75 * 8e-5 - (0.25 * 5e-6 + 0.75 * 25e-6);  // along t1, in the plane
  const Vector3 anchor(place + 25e-6, 0.75 * -4e-5, -5e-5);
  EXPECT_LT((contact.tie_force(0, end) - stiffness * (anchor - Vector3(8e-5, -4e-5, -4e-5))).norm(),
            1e-9 * stiffness * 1e-5);
  const double later = 9e-5;
  contact.begin_step(later, end);
  const Vector3 carried = anchor + Vector3(2e-5, 0.0, -4e-5);
  EXPECT_LT((contact.tie_force(0, moved(carried)).norm()), 1e-9 * stiffness * 1e-5);
  EXPECT_EQ(contact.release_pulled(moved(carried + Vector3(0.0, 0.0, 1e-6))), 0);  // pushed
  EXPECT_EQ(contact.release_pulled(moved(carried - Vector3(0.0, 0.0, 1e-6))), 4);
  EXPECT_EQ(contact.tie_force(0, moved(carried)).norm(), 0.0);
}

/// Until it is anchored a point that touches is held as it will be then, and by nothing where it
/// only just touches.
TEST(StaticContact, HoldsWhatTouchesAsItsAnchorWill) {
  const LatticeBody body = confined_block(ModelKind::hookean, Kinematics::small, 1e8);
  const lattice::ElasticSystem system(body);
  const auto moved = [&](const Vector3& by) {
    return on_particles(body, [&](const Vector3&) -> Vector3 { return by; });
  };
  for (const lattice::ContactLaw law :
       {lattice::ContactLaw{ContactMode::stick}, lattice::ContactLaw{ContactMode::coulomb, 10.0},
        lattice::ContactLaw{ContactMode::coulomb, 0.1}}) {
    StaticContact contact(body, plane_above(height), law);
    const VectorXd start = moved({0.0, 0.0, -4e-5}), end = moved({8e-5, -4e-5, -4e-5});
    contact.begin_step(1e-5, moved({0.0, 0.0, 0.0}));  // away from the plane: nothing touches
    contact.begin_step(5e-5, start);
    contact.update_ties(end);
    const Vector3 force = contact.tie_force(0, end);
    const double energy = contact.energy(end);
    EXPECT_GT(force.head<2>().norm(), 0.0);
    VectorXd forces = VectorXd::Zero(body.unknowns());
    contact.add(end, system, forces, nullptr);
    const VectorXd push = moved({1e-9, 2e-9, 3e-9});
    EXPECT_NEAR(contact.energy(end + push) - contact.energy(end - push), -2.0 * forces.dot(push),
                1e-6 * std::abs(forces.dot(push)));
    EXPECT_EQ(contact.anchor_touching(start, 1e-5, end), 4);
    EXPECT_LT((contact.tie_force(0, end) - force).norm(), 1e-12 * force.norm());
    EXPECT_GT(energy, 0.0);
  }
  StaticContact contact(body, plane_above(height), ContactMode::stick);
  contact.begin_step(1e-5, moved({0.0, 0.0, 0.0}));
  contact.begin_step(5e-5, moved({0.0, 0.0, -4e-5}));
  const VectorXd just = moved({8e-5, 0.0, -5e-5 + 1e-13});
  contact.update_ties(just);
  EXPECT_LT(contact.tie_force(0, just).norm(), 1e-11 * body.outer[0].stiffness);
}

TEST(StaticContact, PlaneFollowsTheContract) {
  meshes::PressProtocol protocol;
  protocol.tilt = 0.4;
  protocol.lateral = 6e-4;
  protocol.depth = 2e-3;
  const meshes::Geometry geometry;
  const auto plane = lattice::press_plane(protocol, geometry);
  EXPECT_LT((plane.normal - Vector3(-std::sin(0.4), 0.0, -std::cos(0.4))).norm(), 1e-15);
  EXPECT_LT((plane.t1 - (Vector3::UnitX() - plane.normal * plane.normal.x()).normalized()).norm(),
            1e-15);
  EXPECT_LT((plane.t2 - Vector3::UnitY()).norm(), 1e-15);
  const double depth = 5e-4;
  const Vector3 expected = (depth - geometry.tip_radius) * plane.normal + 1.5e-4 * plane.t1;
  EXPECT_LT((plane.point(depth) - expected).norm(), 1e-17);
}
