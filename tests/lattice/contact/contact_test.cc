#include "lattice/contact/contact.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fixtures;
using lattice::ContactLaw;
using lattice::Kinematics;
using lattice::LatticeModel;
using lattice::ModelKind;
using lattice::Plane;
using lattice::PlaneContact;
using lattice::State;
using meshes::ContactMode;

namespace {

constexpr double clearance = 0.5e-3;

Plane plane_above() {
  return {Vector3(0.0, 0.0, 0.01 + clearance), -Vector3::UnitZ()};
}

std::size_t pole(const LatticeModel& model) {
  std::size_t best = model.particles.front();
  for (const std::size_t i : model.particles) {
    const Vector3 x = model.rest_position(i);
    if (std::hypot(x.x(), x.y()) < 1e-9 && x.z() > model.rest_position(best).z()) best = i;
  }
  return best;
}

struct PublishedPress {
  LatticeModel model = tip(ModelKind::published, Kinematics::finite, 8);
  State state{model};
  lattice::VectorField force{model.points()};
  std::size_t top = pole(model);

  explicit PublishedPress(const ContactLaw& law) : contact(model, plane_above(), law) {
    contact.resolve(state, force, plane_above(), 1e-4);  // the configuration before the step
  }
  double mass() const { return model.mass[top]; }
  /// Of the pole particle, in world axes.
  Vector3 at(const lattice::VectorField& field) const { return model.grid.axes * field.at(top); }
  void set(lattice::VectorField& field, const Vector3& value) const {
    field.set(top, model.grid.axes.transpose() * value);
  }
  void add(lattice::VectorField& field, const Vector3& value) const {
    set(field, at(field) + value);
  }
  /// The pole particle, as Finger does.
  void move(double step) {
    state.velocity.add(top, step / mass() * force.at(top));
    state.displacement.add(top, step * state.velocity.at(top));
  }
  PlaneContact contact;
};

}  // namespace

TEST(Contact, AnchorsAtTheInterpolatedFirstTouch) {
  PublishedPress press(ContactMode::stick);
  // From the rest position through the plane in one step, moving sideways as well; the plane is
  // crossed after 0.5/0.8 of the way.
  press.set(press.state.displacement, {0.4e-3, -0.2e-3, 0.8e-3});
  press.set(press.state.velocity, {4.0, -2.0, 8.0});
  const Vector3 impulse =
      press.contact.resolve(press.state, press.force, plane_above(), 1e-4).force;
  const Vector3 touch = 0.625 * Vector3(0.4e-3, -0.2e-3, 0.8e-3);
  EXPECT_NEAR((press.at(press.state.displacement) - touch).norm(), 0.0, 1e-15);
  EXPECT_EQ(press.at(press.state.velocity), Vector3::Zero());
  EXPECT_NEAR((impulse + press.model.mass[press.top] * Vector3(4.0, -2.0, 8.0)).norm(), 0.0, 1e-15);
  EXPECT_EQ(press.contact.anchored(), 1);
  EXPECT_NEAR(press.contact.radius(), 0.0, 1e-12);
}

TEST(Contact, StickHoldsTheAnchorEvenAgainstTension) {
  PublishedPress press(ContactMode::stick);
  press.set(press.state.displacement, {0.0, 0.0, 0.8e-3});
  press.contact.resolve(press.state, press.force, plane_above(), 1e-4);
  const Vector3 held = press.at(press.state.displacement);
  press.set(press.force, {0.3, 0.2, -0.1});  // pulls away from the plane
  press.add(press.state.displacement, {1e-5, 0.0, -1e-5});
  const Vector3 impulse =
      press.contact.resolve(press.state, press.force, plane_above(), 1e-4).force;
  EXPECT_EQ(press.at(press.state.displacement), held);
  EXPECT_NEAR((impulse + 1e-4 * Vector3(0.3, 0.2, -0.1)).norm(), 0.0, 1e-18);
}

TEST(Contact, FrictionlessHoldsOnlyTheNormalAndOnlyInCompression) {
  PublishedPress press(ContactMode::frictionless);
  press.set(press.state.displacement, {0.1e-3, 0.0, 0.8e-3});
  press.set(press.state.velocity, {1.0, 0.0, 8.0});
  press.contact.resolve(press.state, press.force, plane_above(), 1e-4);
  EXPECT_NEAR((press.at(press.state.displacement) - Vector3(0.1e-3, 0.0, clearance)).norm(), 0.0,
              1e-15);
  EXPECT_EQ(press.at(press.state.velocity), Vector3(1.0, 0.0, 0.0));

  press.set(press.force, {0.5, 0.0, 0.2});  // pressed against the plane, dragged sideways
  press.move(1e-4);
  const Vector3 reaction =
      press.contact.resolve(press.state, press.force, plane_above(), 1e-4).force;
  EXPECT_NEAR((reaction - Vector3(0.0, 0.0, -0.2e-4)).norm(), 0.0, 1e-18);
  const double speed = 1.0 + 1e-4 * 0.5 / press.mass();
  EXPECT_NEAR(press.at(press.state.velocity).x(), speed, 1e-12 * speed);
  EXPECT_NEAR(press.at(press.state.displacement).x(), 0.1e-3 + 1e-4 * speed, 1e-15);

  press.set(press.force, {0.0, 0.0, -0.2});  // pulled off
  press.move(1e-4);
  EXPECT_EQ(press.contact.resolve(press.state, press.force, plane_above(), 1e-4).force,
            Vector3::Zero());
  EXPECT_EQ(press.contact.anchored(), 0);
}

TEST(Contact, ParticlesTouchByThemselves) {
  // Moving the undeformed tip up by clearance + delta, each particle crosses when it reaches the
  // plane; at R/10 only the pole has, and by R - a the whole layer below it.
  const LatticeModel model = tip(ModelKind::published, Kinematics::finite, 10);
  const Eigen::Matrix3d to_grid = model.grid.axes.transpose();
  for (const double delta : {0.6e-3, 1.1e-3}) {
    PlaneContact contact(model, plane_above(), ContactMode::stick);
    State state(model);
    const lattice::VectorField force(model.points());
    contact.resolve(state, force, plane_above(), 1e-4);
    for (const std::size_t i : model.particles) {
      state.displacement.set(i, to_grid * Vector3(0.0, 0.0, clearance + delta));
    }
    contact.resolve(state, force, plane_above(), 1e-4);
    int crossed = 0;
    double radius = 0.0;
    for (std::size_t b = 0; b < model.boundary.size(); ++b) {
      const Vector3 x = model.rest_position(model.boundary[b]);
      EXPECT_EQ(contact.holds(b), x.z() + delta > 0.01 + 1e-12);
      if (!contact.holds(b)) continue;
      ++crossed;
      radius = std::max(radius, std::hypot(x.x(), x.y()));
    }
    EXPECT_EQ(contact.anchored(), crossed);
    EXPECT_NEAR(contact.radius(), radius, 1e-12);
    EXPECT_EQ(crossed == 1, delta < model.spacing());
  }
}

TEST(Contact, CoulombSticksUpToMuTimesThePushAndSlidesUnderExactlyThat) {
  const double mu = 0.4, push = 0.2, step = 1e-4;
  for (const double share : {0.999, 1.001, 3.0}) {
    PublishedPress press(ContactLaw{ContactMode::coulomb, mu});
    press.set(press.state.displacement, {0.0, 0.0, clearance});
    press.set(press.state.velocity, {0.0, 0.0, 1e-9});
    press.add(press.state.displacement, {0.0, 0.0, 1e-13});
    press.contact.resolve(press.state, press.force, plane_above(), step);
    const Vector3 held = press.at(press.state.displacement);
    const Vector3 drag = share * mu * push * Vector3(0.6, -0.8, 0.0);
    press.set(press.force, drag + push * Vector3::UnitZ());
    press.move(step);
    const Vector3 impulse =
        press.contact.resolve(press.state, press.force, plane_above(), step).force;
    EXPECT_NEAR(impulse.z(), -step * push, 1e-15);
    const Vector3 friction(impulse.x(), impulse.y(), 0.0);
    const double expected = std::min(share, 1.0) * mu * push;
    EXPECT_LT((friction + step * expected * drag.normalized()).norm(), 1e-12 * step * push);
    EXPECT_EQ(press.contact.sliding(), share > 1.0 ? 1 : 0);
    if (share < 1.0) {
      EXPECT_EQ(press.at(press.state.displacement), held);
      EXPECT_EQ(press.at(press.state.velocity), Vector3::Zero());
    }
  }
}

TEST(Contact, ASlidingParticleComesToRestWithoutTurningBack) {
  // Thrown along the plane: it stops after v²/(2 mu g), g the push over its mass.
  const double mu = 0.5, step = 1e-6, speed = 0.3;
  PublishedPress press(ContactLaw{ContactMode::coulomb, mu});
  const double push = 10.0 * press.mass();
  press.set(press.state.displacement, {0.0, 0.0, clearance + 1e-13});
  press.set(press.state.velocity, {speed, 0.0, 0.0});
  press.contact.resolve(press.state, press.force, plane_above(), step);
  const double start = press.at(press.state.displacement).x();
  press.set(press.force, {0.0, 0.0, push});
  double last = speed;
  int steps = 0;
  while (last > 0.0 && steps < 100000) {
    press.move(step);
    press.contact.resolve(press.state, press.force, plane_above(), step);
    const double now = press.at(press.state.velocity).x();
    EXPECT_LT(now, last);
    last = now;
    ++steps;
  }
  EXPECT_EQ(last, 0.0);
  const double way = speed * speed / (2.0 * mu * 10.0);
  EXPECT_NEAR(press.at(press.state.displacement).x() - start, way, 2.0 * speed * step);
  EXPECT_EQ(press.contact.sliding(), 0);
  EXPECT_EQ(press.contact.anchored(), 1);
  press.set(press.force, {0.0, 0.0, -push});
  press.move(step);
  press.contact.resolve(press.state, press.force, plane_above(), step);
  EXPECT_EQ(press.contact.anchored(), 0);
}

TEST(Contact, FollowsAPlaneThatMovesAndTilts) {
  // A particle that sticks stays where it is on the plane; one that slides stays on the plane.
  for (const ContactLaw& law :
       {ContactLaw{ContactMode::stick}, ContactLaw{ContactMode::coulomb, 9.0},
        ContactLaw{ContactMode::coulomb, 0.1}, ContactLaw{ContactMode::frictionless}}) {
    PublishedPress press(law);
    Plane plane = plane_above();
    const double step = 1e-5;
    press.set(press.state.displacement, {1e-4, 0.0, clearance + 1e-13});
    press.set(press.state.velocity, {0.0, 0.0, 1e-9});
    press.contact.resolve(press.state, press.force, plane, step);
    const auto place = [&] {
      return Vector3(press.model.rest_position(press.top) + press.at(press.state.displacement));
    };
    plane.velocity = {0.02, 0.01, -0.03};
    plane.angular_velocity = {0.0, 5.0, 1.0};
    const Vector3 fixed = plane.fixed(place());
    press.set(press.force, {0.0, 0.0, 100.0 * press.mass()});
    for (int n = 0; n < 500; ++n) {
      press.move(step);
      press.contact.resolve(press.state, press.force, plane, step);
      plane = plane.after(step);
    }
    ASSERT_EQ(press.contact.anchored(), 1);
    EXPECT_NEAR(plane.gap(place()), 0.0, 1e-12);
    const double slipped = (plane.fixed(place()) - fixed).norm();
    if (law.mode == ContactMode::stick || law.friction > 1.0) {
      EXPECT_LT(slipped, 1e-12);
      EXPECT_LT((press.at(press.state.velocity) - plane.velocity_at(place())).norm(), 1e-5);
    } else {
      EXPECT_GT(slipped, 1e-5);
    }
  }
}
