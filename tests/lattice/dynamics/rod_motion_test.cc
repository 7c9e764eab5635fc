/// The rod alone in motion: what is conserved, and rigid bodies whose motion is known.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>

#include "lattice/model/rod.h"

using namespace fingertip;
using Eigen::Matrix3d;
using lattice::RodBody;
using lattice::RodState;
using meshes::Vector3;

namespace {

/// Three different moments of inertia, on axes that are none of the frame's.
RodBody crooked_body() {
  RodBody body = lattice::rod_body({}, {});
  const Matrix3d axes = lattice::rotation_by({0.4, -0.7, 0.2}).toRotationMatrix();
  body.inertia = axes * Vector3(3e-7, 5e-7, 7e-7).asDiagonal() * axes.transpose();
  return body;
}

RodState tumbling() {
  RodState rod(crooked_body());
  rod.set_velocity({0.1, -0.2, 0.3}, {40.0, 25.0, -30.0});
  return rod;
}

RodState after(RodState rod, double duration, int steps) {
  for (int n = 0; n < steps; ++n) rod.drift(duration / steps);
  return rod;
}

/// Angle between two orientations [rad].
double apart(const RodState& a, const RodState& b) {
  return a.pose().orientation.angularDistance(b.pose().orientation);
}

constexpr double gravity = 9.81;

/// The force at the endpoint that keeps it where it is: M (force + weight)/M + a x r + w x (w x r)
/// = 0 with I a = r x force - w x I w, r from the centre to the endpoint.
Vector3 hook(const RodState& rod) {
  const RodBody& body = rod.body();
  const Matrix3d turn = rod.pose().orientation.toRotationMatrix();
  const Matrix3d inverse = turn * body.inertia.inverse() * turn.transpose();
  const Vector3 r = rod.endpoint() - rod.centre(), w = rod.angular_velocity();
  Matrix3d cross;
  cross << 0.0, -r.z(), r.y(), r.z(), 0.0, -r.x(), -r.y(), r.x(), 0.0;
  const Vector3 own = Vector3(0.0, 0.0, -gravity) +
                      (inverse * -w.cross(rod.angular_momentum())).cross(r) + w.cross(w.cross(r));
  const Matrix3d response = Matrix3d::Identity() / body.mass - cross * inverse * cross;
  return response.ldlt().solve(-own);
}

/// Kick by the hook and the weight, then drift: symplectic Euler.
void swing(RodState& rod, double step) {
  const Vector3 weight(0.0, 0.0, -gravity * rod.body().mass);
  const Vector3 force = hook(rod), at = rod.endpoint();
  rod.kick({weight, Vector3::Zero()}, rod.centre(), step);
  rod.kick({force, Vector3::Zero()}, at, step);
  rod.drift(step);
}

/// Moment of inertia across the axis about the endpoint, and the lever of the weight.
struct Pendulum {
  double inertia, along, moment;
};
Pendulum pendulum(const RodBody& body) {
  const double lever = (body.centre - body.endpoint).norm();
  return {body.inertia(0, 0) + body.mass * lever * lever, body.inertia(2, 2),
          body.mass * gravity * lever};
}

}  // namespace

TEST(RodInFlight, ConservesMomentaExactlyAndEnergyToSecondOrder) {
  const RodState start = tumbling();
  double worst[3];
  for (int level = 0; level < 3; ++level) {
    RodState rod = start;
    const int steps = 200 << level;
    worst[level] = 0.0;
    for (int n = 0; n < steps; ++n) {
      rod.drift(0.2 / steps);
      worst[level] =
          std::max(worst[level], std::abs(rod.kinetic_energy() / start.kinetic_energy() - 1));
    }
    EXPECT_EQ(rod.momentum(), start.momentum());
    EXPECT_EQ(rod.angular_momentum(), start.angular_momentum());
  }
  EXPECT_LT(worst[0], 1e-3);
  for (int level = 0; level < 2; ++level) {
    EXPECT_GT(worst[level] / worst[level + 1], 3.6) << level;
  }
}

TEST(RodInFlight, TheOrientationConvergesToSecondOrder) {
  const RodState fine = after(tumbling(), 0.2, 51200);
  const double coarse = apart(after(tumbling(), 0.2, 400), fine);
  const double halved = apart(after(tumbling(), 0.2, 800), fine);
  EXPECT_LT(coarse, 1e-3);
  EXPECT_NEAR(coarse / halved, 4.0, 0.3);
}

/// The axis of a free symmetric top goes around L at the rate |L|/I_across while the body turns
/// about its axis at L_3 (1/I_along - 1/I_across).
TEST(RodInFlight, PrecessesAsAFreeSymmetricTopToSecondOrder) {
  RodState start(lattice::rod_body({}, {}));
  start.set_velocity(Vector3::Zero(), {5.0, 3.0, 40.0});
  const Vector3 momentum = start.angular_momentum();
  const double across = start.body().inertia(0, 0), along = start.body().inertia(2, 2);
  const double duration = 0.05;
  const Eigen::Quaterniond expected =
      lattice::rotation_by(duration / across * momentum) *
      lattice::rotation_by(duration * momentum.z() * (1 / along - 1 / across) * Vector3::UnitZ());
  const auto error = [&](int steps) {
    return after(start, duration, steps).pose().orientation.angularDistance(expected);
  };
  const double coarse = error(200), halved = error(400);
  EXPECT_LT(coarse, 1e-3);
  EXPECT_NEAR(coarse / halved, 4.0, 0.2);
}

TEST(RodOnAHook, SwingsAtThePendulumsFrequency) {
  const RodBody body = lattice::rod_body({}, {});
  // The tip's side hangs down: turned over, and a little further.
  const double lean = 0.01;
  RodState rod(body);
  rod.set_state(body.centre, lattice::rotation_by({M_PI + lean, 0.0, 0.0}), Vector3::Zero(),
                Vector3::Zero());
  const Pendulum p = pendulum(body);
  const double period = 2.0 * M_PI * std::sqrt(p.inertia / p.moment) * (1.0 + lean * lean / 16.0);
  const Vector3 hung = rod.endpoint();
  const double step = period / 20000;
  double before = lean, crossing = 0.0;
  int crossings = 0;
  for (int n = 1; crossings < 2 && n < 30000; ++n) {
    swing(rod, step);
    const double now = (rod.pose().orientation * Vector3::UnitZ()).y();  // sine of the lean
    if (before * now < 0.0) {
      const double at = step * (n - now / (now - before));
      if (++crossings == 2) crossing = at - crossing;
      if (crossings == 1) crossing = at;
    }
    before = now;
  }
  EXPECT_NEAR(2.0 * crossing / period, 1.0, 2e-4);
  EXPECT_LT((rod.endpoint() - hung).norm(), 1e-6);
}

/// A top on its endpoint in steady precession: I_across W² cos(lean) - L_3 W + M g l = 0.
TEST(RodOnAHook, PrecessesAsAHeavyTopToFirstOrder) {
  const RodBody body = lattice::rod_body({}, {});
  const Pendulum p = pendulum(body);
  const double lean = 0.4, slow = 20.0;
  const double spin = p.inertia * slow * std::cos(lean) + p.moment / slow;  // L_3
  const auto azimuth_error = [&](int steps) {
    RodState rod(body);
    const Eigen::Quaterniond turn = lattice::rotation_by({0.0, lean, 0.0});
    const Vector3 axis = turn * Vector3::UnitZ();
    const Vector3 up = Vector3::UnitZ();
    const Vector3 rate = slow * (up - axis * axis.dot(up)) + spin / p.along * axis;
    rod.set_state(body.centre, turn, Vector3::Zero(), Vector3::Zero());
    rod.set_velocity(rate.cross(rod.centre() - rod.endpoint()), rate);
    const double duration = 0.05;
    for (int n = 0; n < steps; ++n) swing(rod, duration / steps);
    const Vector3 end = rod.pose().orientation * Vector3::UnitZ();
    EXPECT_NEAR(std::acos(end.z()), lean, 2e-2);
    return std::abs(std::atan2(end.y(), end.x()) - slow * duration);
  };
  const double coarse = azimuth_error(2000), halved = azimuth_error(4000);
  EXPECT_LT(coarse, 5e-3);
  EXPECT_NEAR(coarse / halved, 2.0, 0.2);
}
