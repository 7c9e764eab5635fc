#include "lattice/contact.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fixtures.h"

using namespace fingertip;
using namespace fixtures;
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

  explicit PublishedPress(ContactMode mode) : contact(model, plane_above(), mode) {
    contact.resolve(state, force, 1e-4);  // the configuration before the step
  }
  PlaneContact contact;
};

}  // namespace

TEST(Contact, AnchorsAtTheInterpolatedFirstTouch) {
  PublishedPress press(ContactMode::stick);
  // From the rest position through the plane in one step, moving sideways as well; the plane is
  // crossed after 0.5/0.8 of the way.
  press.state.displacement.set(press.top, {0.4e-3, -0.2e-3, 0.8e-3});
  press.state.velocity.set(press.top, {4.0, -2.0, 8.0});
  const Vector3 impulse = press.contact.resolve(press.state, press.force, 1e-4);
  const Vector3 touch = 0.625 * Vector3(0.4e-3, -0.2e-3, 0.8e-3);
  EXPECT_NEAR((press.state.displacement.at(press.top) - touch).norm(), 0.0, 1e-15);
  EXPECT_EQ(press.state.velocity.at(press.top), Vector3::Zero());
  EXPECT_NEAR((impulse + press.model.mass[press.top] * Vector3(4.0, -2.0, 8.0)).norm(), 0.0, 1e-15);
  EXPECT_EQ(press.contact.anchored(), 1);
  EXPECT_NEAR(press.contact.radius(), 0.0, 1e-12);
}

TEST(Contact, StickHoldsTheAnchorEvenAgainstTension) {
  PublishedPress press(ContactMode::stick);
  press.state.displacement.set(press.top, {0.0, 0.0, 0.8e-3});
  press.contact.resolve(press.state, press.force, 1e-4);
  const Vector3 held = press.state.displacement.at(press.top);
  press.force.set(press.top, {0.3, 0.2, -0.1});  // pulls away from the plane
  press.state.displacement.add(press.top, {1e-5, 0.0, -1e-5});
  const Vector3 impulse = press.contact.resolve(press.state, press.force, 1e-4);
  EXPECT_EQ(press.state.displacement.at(press.top), held);
  EXPECT_NEAR((impulse + 1e-4 * Vector3(0.3, 0.2, -0.1)).norm(), 0.0, 1e-18);
}

TEST(Contact, FrictionlessHoldsOnlyTheNormalAndOnlyInCompression) {
  PublishedPress press(ContactMode::frictionless);
  press.state.displacement.set(press.top, {0.1e-3, 0.0, 0.8e-3});
  press.state.velocity.set(press.top, {1.0, 0.0, 8.0});
  press.contact.resolve(press.state, press.force, 1e-4);
  EXPECT_NEAR((press.state.displacement.at(press.top) - Vector3(0.1e-3, 0.0, clearance)).norm(),
              0.0, 1e-15);
  EXPECT_EQ(press.state.velocity.at(press.top), Vector3(1.0, 0.0, 0.0));

  press.force.set(press.top, {0.5, 0.0, 0.2});  // pressed against the plane, dragged sideways
  press.state.displacement.add(press.top, {1e-5, 0.0, 1e-5});
  const Vector3 reaction = press.contact.resolve(press.state, press.force, 1e-4);
  EXPECT_NEAR((reaction - Vector3(0.0, 0.0, -0.2e-4)).norm(), 0.0, 1e-18);
  EXPECT_NEAR(press.state.displacement.at(press.top).x(), 0.11e-3, 1e-15);

  press.force.set(press.top, {0.0, 0.0, -0.2});  // pulled off
  press.state.displacement.add(press.top, {0.0, 0.0, -1e-6});
  EXPECT_EQ(press.contact.resolve(press.state, press.force, 1e-4), Vector3::Zero());
  EXPECT_EQ(press.contact.anchored(), 0);
}

TEST(Contact, ParticlesTouchByThemselves) {
  // Moving the undeformed tip up by clearance + delta, each particle crosses when it reaches the
  // plane; at R/10 only the pole has, and by R - a the whole layer below it.
  const LatticeModel model = tip(ModelKind::published, Kinematics::finite, 10);
  for (const double delta : {0.6e-3, 1.1e-3}) {
    PlaneContact contact(model, plane_above(), ContactMode::stick);
    State state(model);
    const lattice::VectorField force(model.points());
    contact.resolve(state, force, 1e-4);
    for (const std::size_t i : model.particles) {
      state.displacement.set(i, {0.0, 0.0, clearance + delta});
    }
    contact.resolve(state, force, 1e-4);
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
