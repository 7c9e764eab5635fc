/// Presses that break the symmetry: tilt, lateral motion, and Coulomb's friction between.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/fem_reference/press/pressing.h"

using namespace fingertip;
using fem_reference::PressState;
using fem_reference::ReferenceJob;
using fem_reference::Strain;
using meshes::ContactMode;

namespace {

/// Nothing left of what breaks the symmetry, yet on the half mesh.
constexpr double hardly = 1e-13;

TEST(TiltedPress, UprightHalfEqualsQuarter) {
  for (const ContactMode mode : {ContactMode::frictionless, ContactMode::stick}) {
    ReferenceJob job = small_press();
    job.protocol.contact = mode;
    const PressState quarter = pressed(job, 0.05);
    job.protocol.tilt = hardly;
    const PressState half = pressed(job, 0.05);
    EXPECT_NEAR(half.normal_force / quarter.normal_force, 1.0, 1e-7);
    EXPECT_NEAR(half.energy / quarter.energy, 1.0, 1e-7);
    EXPECT_NEAR(half.max_pressure / quarter.max_pressure, 1.0, 1e-6);
    EXPECT_NEAR(half.lateral_force_x / half.normal_force, 0.0, 1e-7);
    EXPECT_NEAR(half.torque_y / half.normal_force, 0.0, 1e-9);
    EXPECT_NEAR(half.contact_radius / quarter.contact_radius, 1.0, 5e-3);
  }
}

TEST(TiltedPress, MirrorsWithItsTilt) {
  for (const ContactMode mode : {ContactMode::frictionless, ContactMode::stick}) {
    ReferenceJob job = small_press();
    job.protocol.contact = mode;
    job.protocol.tilt = 0.3;
    const fem_reference::PressState tilted = pressed(job, 0.05);
    job.protocol.tilt = -0.3;
    const fem_reference::PressState mirrored = pressed(job, 0.05);
    EXPECT_NEAR(mirrored.normal_force / tilted.normal_force, 1.0, 1e-6);
    EXPECT_NEAR(mirrored.torque_y / tilted.torque_y, -1.0, 1e-6);
    EXPECT_NEAR(mirrored.lateral_force_x, -tilted.lateral_force_x, 1e-6 * tilted.normal_force);
    if (mode == ContactMode::stick) {
      EXPECT_GT(std::abs(tilted.lateral_force_x), 1e-4 * tilted.normal_force);
    }
  }
}

/// The moment about the endpoint is the push times its arm, which ends within the contact, plus
/// the lateral force times the height of the contact.
TEST(TiltedPress, TorqueIsTheMomentOfTheContactForces) {
  for (const ContactMode mode : {ContactMode::frictionless, ContactMode::stick}) {
    ReferenceJob job = small_press();
    job.protocol.contact = mode;
    for (const double tilt : {0.15, 0.4}) {
      job.protocol.tilt = tilt;
      const fem_reference::PressState sample = pressed(job, 0.05);
      const double R = job.geometry.tip_radius, l = job.geometry.rod_length;
      const double height = R + l * std::cos(tilt);
      const double arm = (sample.torque_y - height * sample.lateral_force_x) / sample.normal_force;
      // Centre of pressure against the plane's foot under the sphere's centre.
      EXPECT_LT(std::abs(arm + l * std::sin(tilt)), 0.1 * sample.contact_radius);
      EXPECT_LT(sample.torque_y, 0.0);
    }
  }
}

TEST(TiltedPress, RodTakesWhatThePlaneGives) {
  ReferenceJob job = small_press();
  job.protocol.contact = ContactMode::stick;
  job.protocol.tilt = 0.2;
  job.protocol.lateral = 3e-4;
  Pressing pressing(job);
  pressing.press.set_longest_step(0.05);
  const fem_reference::PressState sample = pressing.press.advance(1e-3);
  const meshes::Vector3 bond = pressing.press.bond_reaction();
  EXPECT_NEAR(2 * bond.z() / sample.normal_force, 1.0, 1e-9);
  EXPECT_NEAR(-2 * bond.x() / sample.lateral_force_x, 1.0, 1e-8);
}

TEST(LateralPress, StickDragsTheTipAlong) {
  ReferenceJob job = small_press();
  job.protocol.contact = ContactMode::stick;
  job.protocol.lateral = 2e-4;
  const fem_reference::PressState shifted = pressed(job, 0.05);
  EXPECT_GT(shifted.lateral_force_x, 0.05 * shifted.normal_force);
  // Its moment about the endpoint, but for the shift of the pressure.
  const double height = job.geometry.tip_radius + job.geometry.rod_length;
  EXPECT_NEAR(shifted.torque_y, height * shifted.lateral_force_x,
              0.5 * shifted.contact_radius * shifted.normal_force);

  job.protocol.lateral = -2e-4;
  const fem_reference::PressState mirrored = pressed(job, 0.05);
  EXPECT_NEAR(mirrored.lateral_force_x / shifted.lateral_force_x, -1.0, 1e-6);
  EXPECT_NEAR(mirrored.torque_y / shifted.torque_y, -1.0, 1e-6);
  EXPECT_NEAR(mirrored.normal_force / shifted.normal_force, 1.0, 1e-6);

  // The force is linear in the motion while the same nodes touch.
  job.protocol.lateral = 1e-4;
  EXPECT_NEAR(pressed(job, 0.05).lateral_force_x / shifted.lateral_force_x, 0.5, 0.02);
}

TEST(LateralPress, FrictionlessFeelsNothing) {
  ReferenceJob job = small_press();
  const double still = pressed(job).normal_force;
  job.protocol.lateral = 5e-4;
  const fem_reference::PressState sample = pressed(job);
  EXPECT_EQ(sample.lateral_force_x, 0.0);
  EXPECT_NEAR(sample.normal_force / still, 1.0, 1e-7);
  EXPECT_NEAR(sample.torque_y / sample.normal_force, 0.0, 1e-9);
}

ReferenceJob press_and_slide(ContactMode contact, double lateral) {
  ReferenceJob job = small_press();
  job.protocol.contact = contact;
  job.press_to({5e-4, 1e-3});
  job.protocol.lateral = lateral;
  job.protocol.lateral_path = meshes::LateralPath::after;
  job.protocol.lateral_samples = 2;
  return job;
}

/// Along the path of `job`, at all its samples.
std::vector<PressState> states_along(const ReferenceJob& job) {
  Pressing pressing(job);
  pressing.press.set_longest_step(0.05);
  std::vector<PressState> states;
  const meshes::PressPath path(job.protocol);
  for (const double place : path.samples()) states.push_back(pressing.press.advance(place));
  return states;
}

TEST(PressAndSlide, FrictionlessFeelsNothing) {
  for (const Strain strain : {Strain::linear, Strain::finite}) {
    ReferenceJob job = press_and_slide(ContactMode::frictionless, 5e-5);
    job.strain = strain;
    job.press_to({1e-4, 2e-4});
    job.degree = strain == Strain::finite ? 1 : 2;
    const auto states = states_along(job);
    ASSERT_EQ(states.size(), 4u);
    EXPECT_EQ(states[1].lateral_displacement, 0.0);
    EXPECT_EQ(states[3].lateral_displacement, 5e-5);
    for (const PressState& state : states) EXPECT_EQ(state.lateral_force_x, 0.0);
    for (const std::size_t i : {2, 3}) {
      EXPECT_EQ(states[i].indentation, 2e-4);
      EXPECT_NEAR(states[i].normal_force / states[1].normal_force, 1.0, 1e-9);
    }
  }
}

/// On one mesh the way down is that of a press that does not move laterally. While the same nodes
/// touch the tip is a linear spring laterally, and what the plane does is stored in it: at constant
/// depth 1/2 F_x shift. A diagonal drags it less, for what touches late has moved less.
TEST(PressAndSlide, StuckItIsALinearSpringThatStoresTheWork) {
  const ReferenceJob job = press_and_slide(ContactMode::stick, 2e-5);
  const auto states = states_along(job);
  ReferenceJob upright = job;
  upright.protocol.lateral = 0.0;
  upright.protocol.tilt = hardly;  // the half mesh
  const auto straight = states_along(upright);
  for (const std::size_t i : {0, 1})
    EXPECT_NEAR(states[i].normal_force / straight[i].normal_force, 1.0, 1e-12);
  const double force = states[3].lateral_force_x;
  EXPECT_GT(force, 0.0);
  EXPECT_NEAR(states[2].lateral_force_x / force, 0.5, 1e-3);
  const double work = 0.5 * force * 2e-5;
  EXPECT_NEAR((states[3].energy - states[1].energy) / work, 1.0, 0.01);

  ReferenceJob diagonal = job;
  diagonal.protocol.lateral_path = meshes::LateralPath::diagonal;
  EXPECT_LT(states_along(diagonal).back().lateral_force_x, 0.9 * force);
}

/// Far off laterally the trailing edge is pulled off the plane. Nodes that neither hold where they
/// are nor stay away stick anew within the step: the contact converges, and the plane still pulls.
TEST(PressAndSlide, StuckItConvergesFarOffLaterally) {
  ReferenceJob job = press_and_slide(ContactMode::stick, 1.5e-3);
  job.protocol.lateral_samples = 3;
  const auto states = states_along(job);
  ASSERT_EQ(states.size(), job.protocol.samples.size() + 3);
  const std::size_t pressed = job.protocol.samples.size() - 1;
  for (std::size_t i = pressed + 1; i < states.size(); ++i) {
    EXPECT_GT(states[i].lateral_force_x, states[i - 1].lateral_force_x);
    EXPECT_GT(states[i].energy, states[i - 1].energy);
    EXPECT_NEAR(states[i].normal_force / states[pressed].normal_force, 1.0, 0.1);
  }
}

/// Pressed first, the tip slides when mu times the push is reached, and from then on under it.
TEST(PressAndSlide, CoulombSlidesUnderFrictionTimesPush) {
  ReferenceJob job = press_and_slide(ContactMode::coulomb, 1e-3);
  job.protocol.friction = 0.2;
  const auto states = states_along(job);
  EXPECT_EQ(states[3].sliding_nodes, states[3].active_nodes);
  EXPECT_GT(states[1].active_nodes, states[1].sliding_nodes);
  EXPECT_NEAR(states[3].lateral_force_x / states[3].normal_force, 0.2, 0.002);
  EXPECT_LT(std::abs(states[1].lateral_force_x), 1e-3 * states[1].normal_force);
}

/// Small strain follows an obstacle that takes the rubber along: what it presses on stays as it is,
/// and its field adds up to what the plane feels.
TEST(PressAndSlide, SmallStrainFollowsTheObstacle) {
  for (const auto shape : {meshes::ObstacleShape::sphere, meshes::ObstacleShape::cylinder,
                           meshes::ObstacleShape::edge}) {
    for (const ContactMode contact : {ContactMode::stick, ContactMode::coulomb}) {
      SCOPED_TRACE(std::string(name(shape)) + ", " + std::string(name(contact)));
      ReferenceJob job = press_and_slide(contact, 3e-4);
      job.protocol.friction = 0.4;
      job.protocol.obstacle = {.shape = shape, .radius = 6e-3};
      const auto states = states_along(job);
      const PressState &straight = states[1], &aside = states.back();
      EXPECT_NEAR(aside.normal_force, straight.normal_force, 0.01 * straight.normal_force);
      EXPECT_GT(aside.lateral_force_x, 0.0);
      EXPECT_LE(aside.lateral_force_x, 0.4 * aside.normal_force * 1.001);
      const auto sums = meshes::sums_of(aside.contact, job.geometry.rod_endpoint());
      EXPECT_NEAR(-sums.force.z(), aside.normal_force, 1e-9 * aside.normal_force);
      EXPECT_NEAR(sums.force.x(), aside.lateral_force_x, 1e-9 * aside.normal_force);
      EXPECT_NEAR(sums.torque.y(), aside.torque_y,
                  1e-9 * aside.normal_force * job.geometry.rod_length);
      for (const meshes::ContactPoint& point : aside.contact)
        if (contact == ContactMode::coulomb) {
          EXPECT_LE(point.shear.norm(), 0.4 * point.normal_traction + 1e-6 * aside.max_pressure);
        }
    }
  }
}

TEST(CoulombPress, LiesBetweenFrictionlessAndStick) {
  ReferenceJob job = small_press();
  job.press_to({2e-3});
  const auto force = [&](ContactMode mode, double friction) {
    job.protocol.contact = mode;
    job.protocol.friction = friction;
    return pressed(job, 0.04).normal_force;
  };
  const double none = force(ContactMode::frictionless, 0.5);
  const double stuck = force(ContactMode::stick, 0.5);
  double last = none;
  for (const double friction : {0.1, 0.3}) {
    const double now = force(ContactMode::coulomb, friction);
    EXPECT_GT(now, last) << friction;
    last = now;
  }
  EXPECT_LT(last, stuck);
  EXPECT_NEAR(force(ContactMode::coulomb, 1e-5) / none, 1.0, 1e-5);
  EXPECT_NEAR(force(ContactMode::coulomb, 1e3) / stuck, 1.0, 1e-6);
}

TEST(CoulombPress, GrossSlidingPullsWithFrictionTimesPush) {
  ReferenceJob job = small_press();
  job.protocol.contact = ContactMode::coulomb;
  job.protocol.friction = 0.2;
  job.protocol.lateral = 3e-3;
  const PressState state = pressed(job, 0.02);
  const fem_reference::PressState& sample = state;
  EXPECT_LE(sample.lateral_force_x, 0.2 * sample.normal_force * (1 + 1e-9));
  EXPECT_GT(sample.lateral_force_x, 0.198 * sample.normal_force);
  EXPECT_EQ(state.sliding_nodes, state.active_nodes);

  job.protocol.lateral = 3e-5;
  const PressState partial = pressed(job, 0.02);
  EXPECT_LT(partial.lateral_force_x, 0.15 * partial.normal_force);
  EXPECT_GT(partial.lateral_force_x, 0.0);
  EXPECT_LT(partial.sliding_nodes, partial.active_nodes);
}

}  // namespace
