#include "studies/live/rig.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "lattice/control/force_controller.h"
#include "lattice/press/press.h"
#include "studies/live/paced_rig.h"
#include "tests/coarse_press.h"
#include "tests/fingers.h"

using namespace fingertip;
using namespace fingertip::studies;
using namespace std::chrono_literals;
using meshes::Vector3;

TEST(MovingSetPoint, ArrivesWithoutJumpsOrOvershoot) {
  for (const double speed : {1e-3, 0.01, 0.2}) {
    MovingSetPoint point(speed, 3.5e-3, 0.5e-3, 1e-3);
    const double most = std::max(0.5, speed * speed / 0.5e-3);
    double furthest = 0.0;
    meshes::SetPoint before = point.now();
    for (int i = 0; i < 4000; ++i) {
      point.advance();
      const meshes::SetPoint now = point.now();
      EXPECT_LE(std::abs(now.speed - before.speed), most * 1e-3 * (1.0 + 1e-9));
      // The trapezoid of the speeds is the way.
      EXPECT_NEAR(now.distance - before.distance, 0.5e-3 * (now.speed + before.speed), 2e-10);
      EXPECT_LE(std::abs(now.speed), speed * (1.0 + 1e-9));
      furthest = std::max(furthest, now.distance);
      before = now;
    }
    EXPECT_NEAR(before.distance, 3.5e-3, 1e-12) << speed;
    EXPECT_EQ(before.speed, 0.0);
    EXPECT_LT(furthest, 3.5e-3 * (1.0 + 1e-6)) << speed;
  }
}

TEST(MovingSetPoint, TurnsBackWhenTheGoalMoves) {
  MovingSetPoint point(0.05, 3e-3, 0.5e-3, 1e-3);
  for (int i = 0; i < 30; ++i) point.advance();
  EXPECT_NEAR(point.now().speed, 0.05, 1e-9);
  point.want(0.01, 0.2e-3);
  for (int i = 0; i < 1000; ++i) point.advance();
  EXPECT_NEAR(point.now().distance, 0.2e-3, 1e-12);
}

TEST(Hand, PullsLikeASpringWithinItsLimit) {
  const lattice::RodBody rod = lattice::rod_body({}, {});
  Hand hand(rod.inertia_at_endpoint());
  lattice::Measurement m;
  m.pose.position = rod.endpoint;
  EXPECT_TRUE(hand.wrench(m).force.isZero(0.0));
  for (const Vector3& way :
       {Vector3(1e-3, 0.0, 0.0), Vector3(0.0, -2e-3, 0.0), Vector3(1e-3, 1e-3, 1e-3)}) {
    hand.hold(rod.endpoint + way);
    EXPECT_LT((hand.wrench(m).force - 100.0 * way).norm(), 1e-14);  // k = 100 N/m
    // The force alone would turn the rod about its centre of mass; the torque prevents it.
    const Vector3 about_centre =
        hand.last().torque + (rod.endpoint - rod.centre).cross(hand.last().force);
    EXPECT_LT(about_centre.norm(), 1e-15);
  }
  hand.hold(Vector3(100.0, 0.0, 0.0));
  EXPECT_NEAR(hand.wrench(m).force.norm(), 5.0, 1e-12);
  hand.release();
  EXPECT_TRUE(hand.wrench(m).force.isZero(0.0));
}

TEST(Hand, AFreeRodComesToTheHandleWithoutSwinging) {
  lattice::RodState rod(lattice::rod_body({}, {}));
  Hand hand(rod.body().inertia_at_endpoint());
  const Vector3 start = rod.endpoint(), way(3e-3, 1e-3, -2e-3);
  hand.hold(start + way);
  const double frequency = std::sqrt(100.0 / rod.body().mass), period = 1e-4;
  for (int i = 1; i <= 1000; ++i) {
    lattice::Measurement m;
    m.pose = {rod.endpoint(), rod.pose().orientation};
    m.twist = {rod.velocity_at(rod.endpoint()), rod.angular_velocity()};
    rod.kick(hand.wrench(m), rod.endpoint(), period);
    rod.drift(period);
    // Critically damped: 1 - (1 + w t) exp(-w t).
    const double t = i * period, w = frequency;
    const Vector3 expected = start + (1.0 - (1.0 + w * t) * std::exp(-w * t)) * way;
    EXPECT_LT((rod.endpoint() - expected).norm(), 0.02 * way.norm()) << t;
  }
  EXPECT_LT(Eigen::AngleAxisd(rod.pose().orientation).angle(), 1e-6);
}

namespace {

/// The way starts differently; once both rods have come to the same speed, forces agree.
void expect_pressed_alike(lattice::PressSetup setup) {
  setup.protocol.speed = 0.01;
  setup.protocol.clearance = 1e-3;
  const lattice::PressOutcome press = lattice::run_press(setup);
  LiveRig rig(setup);
  LiveSettings deeper = rig.settings();
  deeper.depth = 1.3e-3;  // so that the rod has not begun to slow down at the press's depth
  rig.set(deeper);
  int compared = 0;
  while (rig.row().indentation < 0.98e-3) {
    rig.advance();
    const LiveRow row = rig.row();
    if (row.indentation < 0.6e-3) continue;  // the tips still shake from their starts
    const double expected = press.response.normal_force_at(row.indentation);
    EXPECT_NEAR(row.normal_force, expected, 0.01 * expected) << row.indentation;
    ++compared;
  }
  EXPECT_GT(compared, 5);
}

}  // namespace

TEST(LiveRig, PressesLikeThePressVerb) {
  expect_pressed_alike(coarse_press());
}

TEST(LiveRig, PressesASolidLikeThePressVerb) {
  lattice::PressSetup setup = coarse_press();
  setup.geometry = fingers::solid_dome(32, 24);
  setup.lattice.spacing = setup.geometry.tip_radius / 8;  // four cells through its wall
  setup.rod.density *= 12.0;                              // a lighter hand would sway
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  expect_pressed_alike(setup);
}

/// Tilted, on a ball, at small and large strain: what is painted carries the contact's force, on
/// the obstacle, beside the masses that it holds.
TEST(LiveRig, PaintsTheContactWhereItIs) {
  for (const lattice::Kinematics kinematics :
       {lattice::Kinematics::small, lattice::Kinematics::finite}) {
    lattice::PressSetup setup = coarse_press();
    setup.lattice.kinematics = kinematics;
    if (kinematics == lattice::Kinematics::finite) {
      setup.protocol.tilt = 0.1;
      setup.protocol.obstacle = {meshes::ObstacleShape::sphere, 0.015};
    }
    LiveRig rig(setup);
    while (rig.row().indentation < 0.7e-3) rig.advance();
    const LivePicture picture = rig.picture();
    ASSERT_FALSE(picture.finger.contact.empty());
    Vector3 force = Vector3::Zero();
    double nearest = 1.0;
    for (const meshes::ContactPoint& point : picture.finger.contact) {
      force += point.force();
      if (setup.protocol.obstacle.is_plane()) {
        EXPECT_NEAR(picture.finger.plane.gap(point.place), 0.0, 0.15e-3);
      }
      for (std::size_t i = 0; i < picture.finger.held.size(); ++i)
        if (picture.finger.held[i] != 0)
          nearest = std::min(nearest, (picture.finger.boundary[i] - point.place).norm());
    }
    EXPECT_LT(nearest, 0.5 * setup.lattice.spacing);
    const Vector3 felt = picture.measured.contact->on_tip.force;
    EXPECT_LT((force - felt).norm(), 0.01 * felt.norm());  // a step earlier
  }
}

TEST(LiveRig, ResetRepeatsTheSameBits) {
  LiveRig rig(coarse_press());
  const auto run = [&] {
    for (int i = 0; i < 15; ++i) rig.advance();
    return rig.picture();
  };
  const LivePicture first = run();
  rig.hold(Vector3(0.001, 0.0, -0.03));
  rig.advance();
  rig.reset();
  EXPECT_EQ(rig.row().time, 0.0);
  const LivePicture second = run();
  EXPECT_EQ(first.row.normal_force, second.row.normal_force);
  EXPECT_EQ(first.finger.boundary, second.finger.boundary);
}

TEST(LiveRig, SlidersStayWithinTheirLimitsAndGainsChangeOnTheWay) {
  LiveRig rig(coarse_press());
  LiveSettings wild;
  wild.speed = 1e5;
  wild.depth = -1e5;
  wild.natural_frequency = 0.0;
  wild.derivative_filter = 1e5;
  wild.bond_compensation = -3.0;
  rig.set(wild);
  const LiveLimits& limits = rig.limits();
  EXPECT_EQ(rig.settings().speed, limits.speed.most);
  EXPECT_EQ(rig.settings().depth, limits.depth.least);
  EXPECT_EQ(rig.settings().natural_frequency, limits.natural_frequency.least);
  EXPECT_EQ(rig.settings().bond_compensation, 0.0);
  LiveSettings calm;
  calm.speed = 0.05;
  calm.depth = 0.5e-3;
  rig.set(calm);
  for (int i = 0; i < 60; ++i) rig.advance();
  EXPECT_NEAR(rig.row().indentation, 0.5e-3, 0.02e-3);
}

TEST(LiveRig, TheHandsForceIsTheContactForceAtRest) {
  // Controller off: what holds the pressed rod is the hand alone, and the plane's reaction.
  LiveRig rig(coarse_press());
  LiveSettings settings = rig.settings();
  settings.controller = false;
  rig.set(settings);
  rig.hold(Vector3(0.0, 0.0, -0.03 + 2e-3));
  for (int i = 0; i < 600; ++i) rig.advance();
  const LivePicture picture = rig.picture();
  EXPECT_GT(picture.row.normal_force, 0.01);
  EXPECT_NEAR(picture.hand.force.z(), picture.row.normal_force, 0.01 * picture.row.normal_force);
  EXPECT_NEAR(picture.row.speed, 0.0, 1e-4);
  rig.release();
  for (int i = 0; i < 20; ++i) rig.advance();
  EXPECT_LT(rig.row().speed, 0.0);  // pushed away
}

TEST(LiveRig, AContactForceIsHeldAndChangedOnTheWay) {
  lattice::PressSetup setup = coarse_press();
  lattice::ForceSettings force;
  force.force = 0.05;
  setup.make_controller = [&](const lattice::ControlTask& task) {
    return std::make_unique<lattice::ForceController>(lattice::PidSettings{}, force, task);
  };
  LiveRig rig(setup);
  ASSERT_TRUE(rig.limits().contact_force);
  EXPECT_EQ(rig.settings().contact_force, 0.05);
  const auto steady_force = [&] {
    for (int i = 0; i < 400; ++i) rig.advance();  // twelve time constants of 5 Hz
    return rig.row().normal_force;
  };
  EXPECT_NEAR(steady_force(), 0.05, 5e-4);
  LiveSettings settings = rig.settings();
  settings.contact_force = 0.08;
  rig.set(settings);
  EXPECT_NEAR(steady_force(), 0.08, 8e-4);
  settings.contact_force = 1e5;
  rig.set(settings);
  EXPECT_EQ(rig.settings().contact_force, rig.limits().contact_force->most);
  EXPECT_FALSE(LiveRig(coarse_press()).limits().contact_force);
}

namespace {

lattice::PressSetup at_spacing(double spacing) {
  lattice::PressSetup setup = coarse_press();
  setup.lattice.spacing = spacing;
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, spacing);
  return setup;
}

}  // namespace

TEST(LiveRig, MovesAQuarterUntilTheHandTakesTheRod) {
  lattice::PressSetup whole = coarse_press();
  whole.time_step = 1e-5;  // the longest stable one is another for a part
  whole.protocol.markers = {{0.0, 0.0, 10e-3}, {-3e-3, 2e-3, 8e-3}, {6e-3, -5e-3, 0.0}};
  LiveRig rig(whole);
  EXPECT_EQ(rig.sectors(), 4);
  whole.symmetry = false;
  LiveRig other(whole);
  EXPECT_EQ(other.sectors(), 1);
  EXPECT_EQ(rig.boundary().rest(), other.boundary().rest());  // what is drawn is all of it
  const auto expect_same = [&](double allowed) {
    const LivePicture a = rig.picture(), b = other.picture();
    EXPECT_NEAR(a.row.normal_force, b.row.normal_force, allowed * b.row.normal_force);
    EXPECT_EQ(a.finger.held, b.finger.held);
    for (std::size_t i = 0; i < a.finger.boundary.size(); ++i)
      EXPECT_LT((a.finger.boundary[i] - b.finger.boundary[i]).norm(), allowed * 1e-3);
    ASSERT_EQ(a.markers.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_LT((a.markers[i] - b.markers[i]).norm(), allowed * 1e-3);
  };
  while (rig.row().indentation < 0.8e-3) {
    rig.advance();
    other.advance();
  }
  expect_same(1e-7);
  // The pole's is where the plane holds it, the sleeve's has gone on with the rod.
  const LivePicture now = rig.picture();
  EXPECT_NEAR(now.finger.plane.gap(now.markers[0]), 0.0, 0.2e-3);
  EXPECT_NEAR(now.markers[2].z(), now.finger.rod.position.z(), 0.2e-3);
  const Vector3 place = other.picture().measured.pose.position + Vector3(0.5e-3, 0.0, 0.0);
  rig.hold(place);
  other.hold(place);
  EXPECT_EQ(rig.sectors(), 1);
  EXPECT_EQ(rig.lattices(), 2);
  for (int i = 0; i < 20; ++i) {
    rig.advance();
    other.advance();
  }
  // What sticks was anchored anew.
  EXPECT_NEAR(rig.row().normal_force, other.row().normal_force, 0.01 * other.row().normal_force);
  const Vector3 pulled = other.picture().measured.wrench.force;
  EXPECT_GT(std::abs(pulled.x()), 2e-5);
  EXPECT_NEAR(rig.picture().measured.wrench.force.x(), pulled.x(), 0.05 * std::abs(pulled.x()));
  rig.reset();
  EXPECT_EQ(rig.sectors(), 4);
}

TEST(LiveRig, GoesOnWithACoarserLattice) {
  LiveRig rig(at_spacing(0.01 / 8)), coarse(at_spacing(0.01 / 5));
  const auto rest = [&] {  // the rubber sways on its rod for a while
    for (int i = 0; i < 250; ++i) {
      rig.advance();
      coarse.advance();
    }
  };
  rest();
  rig.go_on_with(at_spacing(0.01 / 5));
  EXPECT_EQ(rig.sectors(), 4);
  EXPECT_NEAR(rig.time(), coarse.time(), 1e-12);
  rest();
  EXPECT_NEAR(rig.row().indentation, coarse.row().indentation, 2e-6);
  EXPECT_NEAR(rig.row().normal_force, coarse.row().normal_force, 0.02 * coarse.row().normal_force);
  EXPECT_EQ(rig.picture().finger.boundary.size(), coarse.picture().finger.boundary.size());
}

namespace {

/// Runs for `seconds` of wall time, as a thread of the program does, or until the lattice changes.
LiveFrame run_paced(PacedRig& paced, double seconds) {
  const auto end = PacedRig::Clock::now() + std::chrono::duration<double>(seconds);
  const auto scene = paced.scene();
  while (PacedRig::Clock::now() < end && paced.scene() == scene) {
    paced.advance();
    while (PacedRig::Clock::now() < std::min(paced.due(), PacedRig::Clock::now() + 50ms)) {
    }
    paced.measure_pace();
  }
  return paced.frame();
}

}  // namespace

TEST(PacedRig, FallsBackToACoarserLatticeThatKeepsUp) {
  const auto coarser = [](double) { return at_spacing(0.01 / 4); };
  PacedRig paced(at_spacing(0.01 / 16), {false, 1.0, coarser});  // far too fine
  const auto scene = paced.frame().scene;
  EXPECT_EQ(scene->title.find("hookean lattice, R/16"), 0U) << scene->title;
  const LiveFrame frame = run_paced(paced, 60.0);
  EXPECT_EQ(frame.scene->title, "hookean lattice, R/4, stick contact, coarser to keep up");
  EXPECT_NE(frame.scene, scene);
  EXPECT_EQ(frame.scene->masses, frame.picture.finger.boundary.size());
  EXPECT_GT(frame.picture.row.time, 0.0);
}

TEST(PacedRig, ObeysWhoeverAskedForALattice) {
  PacedRig paced(at_spacing(0.01 / 16), {false, 1.0, {}});
  EXPECT_EQ(run_paced(paced, 2.0).scene->title, "hookean lattice, R/16, stick contact");
  EXPECT_LT(paced.slowest_factor(), 0.9);
}

TEST(PacedRig, TakesWhatTheFingersShapeAllowsAndThenStays) {
  const auto none = [](double) -> lattice::PressSetup {
    throw meshes::InvalidInput({"lattice.spacing", "", "too coarse", ""});
  };
  PacedRig paced(at_spacing(0.01 / 16), {false, 1.0, none});
  EXPECT_EQ(run_paced(paced, 2.0).scene->title, "hookean lattice, R/16, stick contact");
}
