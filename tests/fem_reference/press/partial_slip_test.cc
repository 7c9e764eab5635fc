// Presses that go on by moving aside or twisting: against closed forms on a thick body, against the
// solid, against themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/fem_reference/press/pressing.h"

using namespace fingertip;
using fem_reference::PressState;
using fem_reference::ReferenceJob;
using fem_reference::Strain;
using meshes::ContactMode;
using meshes::PressStage;
using meshes::StageMove;

namespace {

constexpr double pi = std::numbers::pi;
constexpr int finest = 14;  ///< meshes: 43 nodes over the contact's radius

/// A dome that is flat and thick beside its contact, of 1/70 (2 um) or 1/140 of its radius; nearly
/// incompressible, so that pressing it makes no shear.
ReferenceJob made_thick(ReferenceJob job, double depth) {
  job.geometry.rod_radius = 0.3 * job.geometry.tip_radius;
  job.rubber.youngs_modulus = 2.998 * job.rubber.shear_modulus;
  job.press_to({depth});
  return job;
}

ReferenceJob thick_press(ContactMode contact) {
  return made_thick(meridian_press(contact), 5e-7);
}

/// Presses, and then goes on in one way to one place after the other.
void go_on(ReferenceJob& job, double PressStage::*way, StageMove move,
           const std::vector<double>& places) {
  const double depth = job.protocol.depth;
  job.protocol.program = {{.indentation = depth, .speed = job.protocol.speed}};
  for (const double place : places) {
    job.protocol.program.push_back({.indentation = depth, .speed = 1.0, .move = move});
    job.protocol.program.back().*way = place;
  }
  job.protocol.lateral_samples = 1;
}
void twist_to(ReferenceJob& job, const std::vector<double>& angles) {
  go_on(job, &PressStage::twist, StageMove::twist, angles);
}

/// At all samples, on the last of so many meshes.
std::vector<PressState> states_of(const ReferenceJob& job, int meshes = 1) {
  Pressing pressing(job);
  const meshes::PressPath path(job.protocol);
  std::vector<PressState> states;
  for (int mesh = 0; mesh < meshes; ++mesh) {
    if (mesh > 0 && !pressing.press.refine(0.5)) ADD_FAILURE() << "no finer mesh";
    const bool last = mesh + 1 == meshes;  // the others are refined where they are pressed
    for (const double place : path.samples()) {
      const PressState state = pressing.press.advance(place);
      if (!last) break;
      states.push_back(state);
    }
  }
  return states;
}

/// Of its force on a half space [m].
double hertz_radius(const ReferenceJob& job, double force) {
  const double nu = job.rubber.poissons_ratio(),
               modulus = job.rubber.youngs_modulus / (1.0 - nu * nu);
  return std::cbrt(0.75 * force * job.geometry.tip_radius / modulus);
}

/// Without friction, in the mean square over the contact and point by point, where those of corners
/// and of middles of edges lie on either side; of its own force.
TEST(Pressure, IsHertzs) {
  ReferenceJob job = thick_press(ContactMode::frictionless);
  const PressState state = states_of(job, finest).front();
  const double a = hertz_radius(job, state.normal_force),
               peak = 1.5 * state.normal_force / (pi * a * a);
  double squares = 0.0, area = 0.0, within = 0.0;
  for (const meshes::ContactPoint& point : state.contact) {
    const double r = point.place.head<2>().norm() / a,
                 off = point.normal_traction / peak - std::sqrt(std::max(0.0, 1.0 - r * r));
    squares += point.area * off * off;
    area += point.area;
    if (r < 0.95) within = std::max(within, std::abs(off));
  }
  EXPECT_LT(std::sqrt(squares / area), 3e-3);
  EXPECT_LT(within, 6e-3);
}

TEST(Twist, StartsAsStiffAsAHalfSpaceUnderADisc) {
  ReferenceJob job = thick_press(ContactMode::stick);
  twist_to(job, {1e-3});
  const PressState end = states_of(job, finest).back();
  const double a = hertz_radius(job, end.normal_force);
  EXPECT_NEAR(end.spin_torque, 16.0 / 3.0 * job.rubber.shear_modulus * a * a * a * end.twist,
              0.01 * end.spin_torque);
}

/// Lubkin (1951): moments over the greatest one by G a² twist/(mu N); then the greatest one, and on
/// the way back what Masing's rule makes of the way there, M(b) = M(b*) - 2 M((b* - b)/2).
TEST(Twist, SlipsAsLubkinHasIt) {
  ReferenceJob job = thick_press(ContactMode::coulomb);
  job.protocol.friction = 0.5;
  const double force = states_of(job, finest).front().normal_force, a = hertz_radius(job, force),
               limit = job.protocol.friction * force,
               unit = limit / (job.rubber.shear_modulus * a * a);
  const std::vector<double> angles{0.0385, 0.0794, 0.1234, 0.1716, 0.2257, 0.3656, 10.0, 40.0},
      moments{0.299, 0.527, 0.696, 0.816, 0.897, 0.979, 1.0, 1.0};
  std::vector<double> twists;
  for (const double angle : angles) twists.push_back(angle * unit);
  twist_to(job, twists);
  const std::vector<PressState> states = states_of(job, finest);
  const double greatest = 3.0 * pi / 16.0 * limit * a;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    EXPECT_NEAR(states[i + 1].spin_torque / greatest, moments[i], 0.006 * moments[i]);
    EXPECT_NEAR(states[i + 1].normal_force, force, 1e-3 * force);
  }
  // Whatever the shape, friction at the limit everywhere.
  const PressState& all = states.back();
  double lever = 0.0;
  for (const meshes::ContactPoint& point : all.contact) {
    lever += point.normal_traction * point.area * point.place.head<2>().norm();
    EXPECT_EQ(point.state, meshes::ContactState::slip);
  }
  EXPECT_NEAR(all.spin_torque, job.protocol.friction * lever, 1e-10 * all.spin_torque);
  EXPECT_NEAR(all.torque_z, -all.spin_torque, 1e-10 * all.spin_torque);

  twist_to(job, {0.1234 * unit, 0.2468 * unit, 0.0, -0.2468 * unit});
  const std::vector<PressState> loop = states_of(job, finest);
  EXPECT_NEAR(loop[3].spin_torque, loop[2].spin_torque - 2.0 * loop[1].spin_torque,
              0.01 * loop[2].spin_torque);
  EXPECT_NEAR(loop[4].spin_torque, -loop[2].spin_torque, 0.01 * loop[2].spin_torque);
}

/// Mindlin (1949): force Q over mu N and radius c of what sticks at a displacement u, and Mindlin
/// and Deresiewicz (1953) on the way back. The body around gives way by a length of its own in
/// proportion to Q: 3 % of u here, found at the first place and taken off at the others.
TEST(Aside, SlipsAsMindlinHasIt) {
  ReferenceJob job = small_press();
  job.protocol.contact = ContactMode::coulomb;
  job = made_thick(job, 2e-6);
  job.refinement = 0.5;
  job.protocol.friction = 0.5;
  const double nu = job.rubber.poissons_ratio(), G = job.rubber.shear_modulus,
               depth = job.protocol.depth, R = job.geometry.tip_radius;
  const auto slides_at = [&](double force, double a) {
    return 3.0 * job.protocol.friction * force * (2.0 - nu) / (16.0 * G * a);
  };
  const double modulus = job.rubber.youngs_modulus / (1.0 - nu * nu),
               about = slides_at(4.0 / 3.0 * modulus * std::sqrt(R) * std::pow(depth, 1.5),
                                 std::sqrt(R * depth));
  go_on(job, &PressStage::lateral, StageMove::lateral,
        {0.2 * about, 0.35 * about, 0.7 * about, 0.0, -0.7 * about, 0.0, 0.7 * about});
  constexpr int meshes = 7;  // 8 nodes over the contact's radius
  const std::vector<PressState> states = states_of(job, meshes);
  const auto held = [&](std::size_t i) {
    return states[i].lateral_force_x / (job.protocol.friction * states[i].normal_force);
  };
  double gives = 0.0;  // over Q/(mu N)
  for (std::size_t i = 1; i < 4; ++i) {
    const double a = hertz_radius(job, states[i].normal_force),
                 u = states[i].lateral_displacement / slides_at(states[i].normal_force, a),
                 of_half_space = 1.0 - std::pow(1.0 - held(i), 2.0 / 3.0);
    if (i == 1) gives = (u - of_half_space) / held(i);
    EXPECT_NEAR(of_half_space + gives * held(i), u, 0.01 * u) << i;
    double sticking = 0.0;
    for (const meshes::ContactPoint& point : states[i].contact)
      if (point.state == meshes::ContactState::stick) sticking += point.area;
    EXPECT_NEAR(std::sqrt(sticking / pi) / a, std::cbrt(1.0 - held(i)), 0.02) << i;
  }
  EXPECT_NEAR(gives, 0.0, 0.1);
  // Q(u) = Q* - 2 Q((u* - u)/2); a loop closes.
  EXPECT_NEAR(held(5), -held(3), 0.01 * held(3));
  EXPECT_NEAR(held(4), held(3) - 2.0 * held(2), 0.01 * held(3));
  EXPECT_NEAR(held(6), -held(4), 0.01 * held(3));
  EXPECT_NEAR(held(7), held(3), 0.01 * held(3));
}

TEST(Twist, OfTheMeridianIsThatOfTheSolid) {
  for (const ContactMode contact : {ContactMode::stick, ContactMode::coulomb}) {
    ReferenceJob meridian = meridian_press(contact), solid = small_press();
    solid.refinement = 0.6;
    solid.protocol.contact = contact;
    for (ReferenceJob* job : {&meridian, &solid}) {
      job->protocol.friction = 0.3;
      job->protocol.twist = 0.05;
      job->protocol.lateral_samples = 1;
    }
    const PressState flat = states_of(meridian, 8).back(), whole = states_of(solid).back();
    EXPECT_EQ(whole.twist, 0.05);
    EXPECT_NEAR(flat.normal_force, whole.normal_force, 0.02 * whole.normal_force);
    EXPECT_NEAR(flat.spin_torque, whole.spin_torque, 0.03 * whole.spin_torque);
    EXPECT_NEAR(whole.torque_z, -whole.spin_torque, 1e-3 * whole.spin_torque);
    EXPECT_NEAR(whole.lateral_force_x, 0.0, 1e-3 * whole.normal_force);
  }
}

/// Turned by a right angle the rod has the same finger before it, and what sticks has turned the
/// other way: without contact's history nothing but the twist of the rubber is left.
TEST(Twist, AtLargeStrainIsARotation) {
  ReferenceJob job = small_press();
  job.strain = Strain::finite;
  job.protocol.contact = ContactMode::stick;
  job.protocol.twist = 0.1;
  job.protocol.lateral_samples = 1;
  const PressState there = states_of(job).back();
  ReferenceJob small = job;
  small.strain = Strain::linear;
  EXPECT_NEAR(there.spin_torque, states_of(small).back().spin_torque, 0.1 * there.spin_torque);
  // What moves aside and turns as one turns about another axis: 5 mm/0.1 beside it.
  double aside = 0.0;
  for (const meshes::ContactPoint& point : there.contact)
    aside += point.force().head<2>().norm() * point.place.head<2>().norm();
  EXPECT_NEAR(aside, there.spin_torque, 0.1 * there.spin_torque);
  job.protocol.twist = -0.1;
  const PressState back = states_of(job).back();
  EXPECT_NEAR(back.spin_torque, -there.spin_torque, 1e-4 * there.spin_torque);
  EXPECT_NEAR(back.normal_force, there.normal_force, 1e-5 * there.normal_force);
}

/// An edge under the finger turns with the plane: from along y to along x.
TEST(Twist, TurnsTheObstacle) {
  ReferenceJob job = small_press();
  job.protocol.obstacle = {.shape = meshes::ObstacleShape::cylinder, .radius = 5e-3};
  job.protocol.twist = 0.5 * pi;
  job.protocol.lateral_samples = 1;
  const std::vector<PressState> states = states_of(job);
  const auto spread = [](const PressState& state, int axis) {
    double sum = 0.0;
    for (const meshes::ContactPoint& point : state.contact)
      sum += -point.force().z() * point.place[axis] * point.place[axis];
    return sum / state.normal_force;
  };
  EXPECT_GT(spread(states[0], 1), 1.2 * spread(states[0], 0));
  EXPECT_NEAR(spread(states[1], 0), spread(states[0], 1), 0.05 * spread(states[0], 1));
  EXPECT_NEAR(states[1].normal_force, states[0].normal_force, 0.01 * states[0].normal_force);
}

}  // namespace
