#include "lattice/model/rod.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

using namespace fingertip;
using lattice::RodBody;
using lattice::RodState;
using meshes::Vector3;

namespace {

/// Mass, first and second moments of the rod by midpoint quadrature over slices along z.
RodBody rod_by_quadrature(const meshes::Geometry& g, double density, int slices) {
  RodBody body;
  const double from = -g.rod_length, height = (g.rod_radius - from) / slices;
  double moment = 0.0;
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  // about the origin
  for (int s = 0; s < slices; ++s) {
    const double z = from + (s + 0.5) * height;
    const double radius2 = g.rod_radius * g.rod_radius - (z > 0.0 ? z * z : 0.0);
    const double mass = density * std::numbers::pi * radius2 * height;
    body.mass += mass;
    moment += mass * z;
    second.diagonal() += mass * Vector3(radius2 / 4 + z * z, radius2 / 4 + z * z, radius2 / 2);
  }
  body.centre = Vector3(0.0, 0.0, moment / body.mass);
  const double shift = body.mass * body.centre.z() * body.centre.z();
  body.inertia = second;
  body.inertia(0, 0) -= shift;
  body.inertia(1, 1) -= shift;
  return body;
}

RodState spinning_rod() {
  RodState rod(lattice::rod_body({}, {}));
  rod.set_velocity({0.1, -0.2, 0.3}, {5.0, 3.0, 40.0});
  return rod;
}

}  // namespace

TEST(RodBody, MassCentreAndInertiaMatchQuadrature) {
  const meshes::Geometry geometry;
  const RodBody analytic = lattice::rod_body(geometry, {2700.0});
  const RodBody numeric = rod_by_quadrature(geometry, 2700.0, 20000);
  EXPECT_NEAR(analytic.mass, numeric.mass, 1e-7 * analytic.mass);
  EXPECT_NEAR(analytic.centre.z(), numeric.centre.z(), 1e-7 * geometry.rod_length);
  EXPECT_LT((analytic.inertia - numeric.inertia).norm(), 1e-6 * analytic.inertia.norm());
}

TEST(RodBody, InertiaAtTheEndpointGivesTheKineticEnergy) {
  const RodBody body = lattice::rod_body({}, {});
  RodState rod(body);
  const Vector3 velocity(0.2, -0.1, 0.4), spin(3.0, -5.0, 7.0);
  rod.set_velocity(velocity, spin);
  Eigen::Matrix<double, 6, 1> twist;
  twist << rod.velocity_at(rod.endpoint()), spin;
  EXPECT_NEAR(rod.kinetic_energy(), 0.5 * twist.dot(body.inertia_at_endpoint() * twist),
              1e-12 * rod.kinetic_energy());
}

TEST(RodState, FreeFlightConservesMomentumAndAngularMomentum) {
  RodState rod = spinning_rod();
  const Vector3 momentum = rod.momentum(), spin = rod.angular_momentum(), start = rod.centre();
  for (int i = 0; i < 1000; ++i) rod.drift(1e-4);
  EXPECT_EQ(rod.momentum(), momentum);
  EXPECT_EQ(rod.angular_momentum(), spin);
  EXPECT_NEAR((rod.centre() - start - 0.1 * momentum / rod.body().mass).norm(), 0.0, 1e-14);
  EXPECT_NEAR(rod.pose().orientation.norm(), 1.0, 1e-14);
}

TEST(RodState, PrecessesLikeASymmetricTop) {
  // Free symmetric top: the axis turns about L at the rate |L|/I_across.
  RodState rod = spinning_rod();
  const Vector3 axis = rod.pose().orientation * Vector3::UnitZ();
  const Vector3 along = rod.angular_momentum().normalized();
  const double rate = rod.angular_momentum().norm() / rod.body().inertia(0, 0);
  const double dt = 1e-6, duration = 0.02;
  for (int i = 0; i < int(duration / dt + 0.5); ++i) rod.drift(dt);
  const Vector3 expected = Eigen::AngleAxisd(rate * duration, along) * axis;
  EXPECT_LT((rod.pose().orientation * Vector3::UnitZ() - expected).norm(), 1e-4);
}

TEST(RodState, AKickAtTheEndpointTurnsAboutTheCentre) {
  RodState rod(lattice::rod_body({}, {}));
  rod.kick({Vector3(2.0, 0.0, 0.0), Vector3::Zero()}, rod.endpoint(), 1e-3);
  EXPECT_NEAR(rod.velocity().x(), 2e-3 / rod.body().mass, 1e-12);
  const double arm = rod.endpoint().z() - rod.centre().z();
  EXPECT_NEAR(rod.angular_velocity().y(), arm * 2e-3 / rod.body().inertia(1, 1), 1e-9);
}

TEST(RodState, PoseMovesBodyPointsRigidly) {
  RodState rod = spinning_rod();
  rod.drift(0.05);
  const Vector3 a(0.001, 0.002, 0.003), b(-0.004, 0.0, -0.02);
  EXPECT_NEAR((rod.pose() * a - rod.pose() * b).norm(), (a - b).norm(), 1e-15);
  EXPECT_NEAR((rod.pose() * rod.body().centre - rod.centre()).norm(), 0.0, 1e-15);
}

TEST(Rotations, VectorAndQuaternionAreInverse) {
  EXPECT_EQ(lattice::rotation_vector(Eigen::Quaterniond::Identity()).norm(), 0.0);
  for (const double angle : {1e-12, 1e-3, 1.0, 3.1}) {
    const Vector3 turn = angle * Vector3(1.0, -2.0, 2.0) / 3.0;
    const Eigen::Quaterniond rotation = lattice::rotation_by(turn);
    EXPECT_LT((lattice::rotation_vector(rotation) - turn).norm(), 1e-14 * std::max(angle, 1.0));
    // The same rotation with the other sign.
    const Eigen::Quaterniond other(-rotation.coeffs());
    EXPECT_LT((lattice::rotation_vector(other) - turn).norm(), 1e-14 * std::max(angle, 1.0));
  }
}
