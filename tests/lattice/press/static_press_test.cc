#include "lattice/press/static_press.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "lattice/statics/cut_lattice.h"
#include "meshes/press/limit_surface.h"
#include "tests/lattice/presses.h"

using namespace fingertip;
using lattice::Kinematics;
using lattice::ModelKind;
using lattice::PressSetup;
using lattice::StaticOutcome;
using meshes::ContactMode;
using meshes::PressSample;
using meshes::Vector3;

namespace {

constexpr double gf = 9.80665e-3;  // [N]
constexpr double cm = 1e-2;

PressSetup press_at(int per_radius, std::vector<double> samples_cm,
                    ContactMode contact = ContactMode::frictionless,
                    ModelKind model = ModelKind::hookean,
                    std::optional<Kinematics> kinematics = {}) {
  for (double& sample : samples_cm) sample *= cm;
  return presses::setup_of({.model = model,
                            .per_radius = double(per_radius),
                            .contact = contact,
                            .samples = samples_cm,
                            .kinematics = kinematics});
}

PressSample last_sample(const PressSetup& setup) {
  return lattice::run_static_press(setup).response.samples().back();
}

lattice::LatticeBody body_in_sectors(const PressSetup& setup, int sectors) {
  return build_cut_tip(setup.geometry, setup.rubber, setup.lattice, sectors);
}

void expect_same(const PressSample& a, const PressSample& b, double share, double length) {
  presses::expect_same_load(a, b, share, length);
  EXPECT_NEAR(a.contact_radius, b.contact_radius, share * length);
  EXPECT_NEAR(a.max_pressure, b.max_pressure, share * b.max_pressure);
}

}  // namespace

TEST(StaticPress, HasTheSameBitsWithAnyNumberOfThreads) {
  PressSetup setup = presses::setup_of({.model = lattice::ModelKind::hookean,
                                        .per_radius = 12,
                                        .contact = meshes::ContactMode::stick,
                                        .samples = {1e-3}});
  const auto force = [&](int threads) {
    setup.threads = threads;
    return lattice::run_static_press(setup).response.samples().back().normal_force;
  };
  const double one = force(1);
  EXPECT_GT(one, 0.0);
  EXPECT_EQ(force(3), one);
}

/// Against axisymmetric quadratic finite elements, accurate to 0.03 %
/// (tests/fem_reference/data/press_linear_frictionless.csv).
TEST(StaticPress, AgreesWithTheContinuum) {
  struct Truth {
    double force_gf, radius_cm;
  };
  const std::map<double, Truth> truth = {{0.05, {1.02296, 0.2448}},
                                         {0.10, {3.25628, 0.3494}},
                                         {0.20, {10.22344, 0.4837}},
                                         {0.30, {19.42179, 0.5720}}};
  for (const auto& [per_radius, tolerance] : {std::pair{6, 0.035}, {8, 0.03}, {10, 0.02}}) {
    const auto outcome = lattice::run_static_press(press_at(per_radius, {0.05, 0.1, 0.2, 0.3}));
    EXPECT_EQ(outcome.sectors, 4);
    EXPECT_NEAR(outcome.volume / outcome.exact_volume, 1.0, 1e-5);
    for (const PressSample& sample : outcome.response.samples()) {
      const Truth& exact = truth.at(std::round(sample.indentation / cm * 1e4) / 1e4);
      const double depth_cm = sample.indentation / cm;
      EXPECT_NEAR(sample.normal_force / gf / exact.force_gf, 1.0,
                  depth_cm < 0.075 ? 2 * tolerance : tolerance)
          << per_radius << ' ' << depth_cm;
      // A quarter of a spacing while few cells touch.
      EXPECT_NEAR(sample.contact_radius / cm, exact.radius_cm,
                  depth_cm < 0.075 ? 0.25 / per_radius : 0.01)
          << per_radius << ' ' << depth_cm;
    }
  }
}

/// The continuum that sticks, small strain: 22.08 gf at 0.3 cm where it slides with 19.42.
TEST(StaticPress, SticksLikeTheContinuum) {
  const auto outcome =
      lattice::run_static_press(press_at(8, {0.05, 0.1, 0.2, 0.3}, ContactMode::stick));
  const std::vector<double> truth_gf = {1.03, 3.32, 10.99, 22.08};
  for (std::size_t i = 0; i < truth_gf.size(); ++i) {
    EXPECT_NEAR(outcome.response.samples()[i].normal_force / gf / truth_gf[i], 1.0,
                i == 0 ? 0.06 : 0.02);
  }
}

/// Beside a path whose samples make its steps a tenth as long. An estimate: half of it may be
/// missing where few points touch; deeper it covers, five times at most on average.
TEST(StaticPress, TellsWhatItsStepsLeave) {
  std::vector<double> often;
  for (int i = 1; i <= 100; ++i) often.push_back(0.002 * i);
  for (const Kinematics kinematics : {Kinematics::small, Kinematics::finite}) {
    const auto pressed = [&](const std::vector<double>& samples) {
      PressSetup setup = press_at(8, samples, ContactMode::stick, ModelKind::network, kinematics);
      setup.rubber.shear_modulus = setup.rubber.youngs_modulus / 2.98;  // nu = 0.49
      return lattice::run_static_press(setup);
    };
    const StaticOutcome rare = pressed({0.03, 0.05, 0.1, 0.15, 0.2}), truth = pressed(often);
    EXPECT_LE(rare.steps, 25);
    double told = 0.0, found = 0.0;
    for (const PressSample& sample : rare.response.samples()) {
      const std::size_t row = std::size_t(std::lround(sample.indentation / (0.002 * cm))) - 1;
      const PressSample& fine = truth.response.samples()[row];
      ASSERT_NEAR(fine.indentation, sample.indentation, 1e-12);
      const double off = std::abs(sample.normal_force - fine.normal_force);
      EXPECT_LE(off, 2.0 * (sample.step_error + fine.step_error)) << sample.indentation;
      EXPECT_LT(sample.step_error, 5e-3 * sample.normal_force) << sample.indentation;
      EXPECT_LT(off, 3e-3 * sample.normal_force) << sample.indentation;
      told += sample.step_error / sample.normal_force;
      found += off / sample.normal_force;
    }
    EXPECT_GT(told, found);
    EXPECT_LT(told, 5.0 * found);
  }
  const auto free = lattice::run_static_press(press_at(6, {0.1})).response;
  EXPECT_TRUE(std::isnan(free.samples().back().step_error));
}

/// Law A of the continuum, good to some 0.3 %.
TEST(StaticPress, NetworkAgreesWithLawA) {
  const auto outcome = lattice::run_static_press(
      press_at(8, {0.05, 0.1, 0.2, 0.3, 0.35}, ContactMode::frictionless, ModelKind::network));
  const std::vector<double> truth_gf = {1.038, 3.535, 13.15, 29.74, 41.50};
  for (std::size_t i = 0; i < truth_gf.size(); ++i) {
    EXPECT_NEAR(outcome.response.samples()[i].normal_force / gf / truth_gf[i], 1.0,
                i == 0 ? 0.06 : 0.025);
  }
  EXPECT_GT(outcome.smallest_jacobian, 0.5);
  EXPECT_LT(outcome.smallest_jacobian, 0.9);
}

/// Largest true pressure and radius at 0.3 cm of law A from axisymmetric finite elements
/// (tests/verification/axisymmetric).
TEST(StaticPress, PressureAndRadiusAtLargeStrain) {
  struct Truth {
    ContactMode contact;
    double radius_cm, pressure_gf_cm2;
  };
  for (const Truth& truth : {Truth{ContactMode::frictionless, 0.6578, 41.98},
                             Truth{ContactMode::stick, 0.6488, 50.26}}) {
    const PressSample sample = last_sample(press_at(8, {0.3}, truth.contact, ModelKind::network));
    EXPECT_NEAR(sample.contact_radius / cm / truth.radius_cm, 1.0, 0.025);
    EXPECT_NEAR(sample.max_pressure / (gf / (cm * cm)) / truth.pressure_gf_cm2, 1.0, 0.075);
  }
}

/// Strain is of the order of sqrt(depth/R): ten times less deep, the laws are closer.
TEST(StaticPress, FiniteStrainTendsToSmallStrain) {
  const auto difference = [](double depth_cm) {
    const auto force = [&](Kinematics kinematics) {
      return last_sample(
                 press_at(6, {depth_cm}, ContactMode::frictionless, ModelKind::network, kinematics))
          .normal_force;
    };
    return std::abs(force(Kinematics::finite) / force(Kinematics::small) - 1.0);
  };
  EXPECT_GT(difference(0.2), 0.1);
  EXPECT_LT(difference(0.02), 0.02);
  EXPECT_LT(difference(0.002), 0.001);
}

TEST(StaticPress, PartsAreTheWhole) {
  const double length = meshes::Geometry{}.rod_length;
  for (const ContactMode contact : {ContactMode::frictionless, ContactMode::stick}) {
    const PressSetup setup = press_at(5, {0.1}, contact);
    const PressSample quarter = last_sample(setup);
    EXPECT_EQ(quarter.lateral_force_x, 0.0);
    EXPECT_EQ(quarter.torque_y, 0.0);
    for (const int sectors : {2, 1}) {
      const auto outcome = lattice::run_static_press(setup, body_in_sectors(setup, sectors));
      EXPECT_EQ(outcome.sectors, sectors);
      expect_same(outcome.response.samples().back(), quarter, 1e-7, length);
    }
  }
}

TEST(StaticPress, TiltedHalfIsTheWhole) {
  PressSetup setup = press_at(5, {0.05, 0.1}, ContactMode::stick);
  setup.protocol.tilt = 0.2;
  setup.protocol.lateral = 3e-4;
  const PressSample half = last_sample(setup);
  const auto whole = lattice::run_static_press(setup, body_in_sectors(setup, 1));
  // Anchors are found on states converged to 1e-6 only, on both sides of the mirror plane.
  expect_same(whole.response.samples().back(), half, 1e-6, setup.geometry.rod_length);
  EXPECT_GT(half.lateral_force_x, 0.0);
}

TEST(StaticPress, MirrorsWithTiltAndLateralMotion) {
  PressSetup setup = press_at(5, {0.1}, ContactMode::stick);
  setup.protocol.tilt = 0.3;
  setup.protocol.lateral = 2e-4;
  const PressSample tilted = last_sample(setup);
  setup.protocol.tilt = -0.3;
  setup.protocol.lateral = -2e-4;
  PressSample mirrored = last_sample(setup);
  EXPECT_GT(std::abs(tilted.lateral_force_x), 1e-3 * tilted.normal_force);
  mirrored.lateral_force_x *= -1.0;
  mirrored.torque_y *= -1.0;
  expect_same(mirrored, tilted, 1e-6, setup.geometry.rod_length);
}

/// The rod takes what the plane gives: force, and moment about the endpoint, at rest positions at
/// small strain and at present ones at finite strain.
TEST(StaticPress, BondAndPlaneBalance) {
  for (const Kinematics kinematics : {Kinematics::small, Kinematics::finite}) {
    PressSetup setup =
        press_at(6, {0.15}, ContactMode::frictionless, ModelKind::network, kinematics);
    setup.protocol.tilt = 0.25;
    const auto body = body_in_sectors(setup, 2);
    const auto outcome = lattice::run_static_press(setup, body);
    const Eigen::Matrix3d axes =
        lattice::field_axes(lattice::press_plane(setup.protocol, setup.geometry).normal);
    const auto sums = sums_of(outcome.contact, axes.transpose() * setup.geometry.rod_endpoint());
    const double force = -sums.force.z(), moment = (axes * sums.torque).y();
    const PressSample& sample = outcome.response.samples().back();
    EXPECT_NEAR(sample.normal_force, force, 1e-8 * force);
    EXPECT_NEAR(sample.lateral_force_x, 0.0, 1e-8 * force);
    EXPECT_NEAR(sample.torque_y, moment, 1e-8 * force * setup.geometry.rod_length);
    // The push goes through the contact, near the foot of the sphere's centre.
    const double arm = sample.torque_y / sample.normal_force +
                       setup.geometry.rod_length * std::sin(setup.protocol.tilt);
    EXPECT_LT(std::abs(arm), 0.1 * sample.contact_radius);
  }
}

TEST(StaticPress, LateralMotionDragsOnlyWhatSticks) {
  PressSetup setup = press_at(5, {0.1}, ContactMode::frictionless);
  const double still = last_sample(setup).normal_force;
  setup.protocol.lateral = 3e-4;
  const PressSample sliding = last_sample(setup);
  EXPECT_NEAR(sliding.normal_force, still, 1e-8 * still);
  EXPECT_NEAR(sliding.lateral_force_x, 0.0, 1e-8 * still);
  setup.protocol.contact = ContactMode::stick;
  const PressSample stuck = last_sample(setup);
  EXPECT_GT(stuck.lateral_force_x, 0.05 * stuck.normal_force);
  const double height = setup.geometry.tip_radius + setup.geometry.rod_length;
  EXPECT_NEAR(stuck.torque_y, height * stuck.lateral_force_x,
              0.5 * stuck.contact_radius * stuck.normal_force);
}

/// Down and then laterally, or both at once: a frictionless plane is the same everywhere.
TEST(StaticPress, WithoutFrictionAPlaneMovesOnUnnoticed) {
  for (const Kinematics kinematics : {Kinematics::small, Kinematics::finite}) {
    PressSetup setup =
        press_at(5, {0.1, 0.2}, ContactMode::frictionless, ModelKind::network, kinematics);
    const auto body = body_in_sectors(setup, 2);
    const auto straight = lattice::run_static_press(setup, body).response;
    setup.protocol.lateral = -4e-4;
    const PressSample diagonal = last_sample(setup);
    setup.protocol.lateral_path = meshes::LateralPath::after;
    setup.protocol.lateral_samples = 3;
    const auto after = lattice::run_static_press(setup, body).response;
    ASSERT_EQ(after.samples().size(), 5u);
    ASSERT_EQ(after.sliding().size(), 3u);
    const double force = straight.samples().back().normal_force;
    for (const PressSample& sample : after.samples())
      EXPECT_NEAR(sample.lateral_force_x, 0.0, 1e-8 * force);
    for (const PressSample& sample : after.sliding())
      EXPECT_NEAR(sample.normal_force, force, 1e-8 * force);
    EXPECT_EQ(after.samples().back().lateral_displacement, -4e-4);
    expect_same(after.samples().back(), diagonal, 1e-7, setup.geometry.rod_length);
  }
}

/// Beyond all friction a point sticks, without any it slides free; in between the plane drags the
/// tip along with friction times push once all of it slides, and holds a turn with what its own
/// pressure makes of that.
TEST(StaticPress, SlidesUnderFrictionTimesPush) {
  for (const Kinematics kinematics : {Kinematics::small, Kinematics::finite}) {
    PressSetup setup = press_at(6, {0.1}, ContactMode::coulomb, ModelKind::network, kinematics);
    const auto with = [&](ContactMode contact, double friction) {
      setup.protocol.contact = contact;
      setup.protocol.friction = friction;
      return last_sample(setup);
    };
    const double stuck = with(ContactMode::stick, 0.0).normal_force,
                 free = with(ContactMode::frictionless, 0.0).normal_force;
    // Where a point first touches is found from another trial.
    const double held = with(ContactMode::coulomb, 1e4).normal_force;
    EXPECT_NEAR(held, stuck, 5e-3 * stuck);
    EXPECT_NEAR(with(ContactMode::coulomb, 1e-9).normal_force, free, 1e-7 * free);
    const double between = with(ContactMode::coulomb, 0.3).normal_force;
    EXPECT_GT(between, free);
    EXPECT_LT(between, held);

    setup.protocol.lateral = -2e-3;
    setup.protocol.lateral_path = meshes::LateralPath::after;
    setup.protocol.lateral_samples = 4;
    const StaticOutcome aside = lattice::run_static_press(setup);
    const PressSample& dragged = aside.response.samples().back();
    EXPECT_NEAR(dragged.lateral_force_x, -0.3 * dragged.normal_force, 1e-7 * dragged.normal_force);
    setup.protocol.lateral = 0.0;
    setup.protocol.twist = 0.5;
    const StaticOutcome turned = lattice::run_static_press(setup);
    const PressSample& end = turned.response.samples().back();
    double lever = 0.0;
    for (const auto& point : meshes::samples_of(turned.contact).back()) {
      EXPECT_EQ(point.state, meshes::ContactState::slip);
      lever += point.normal_traction * point.area * point.place.head<2>().norm();
    }
    EXPECT_NEAR(end.spin_torque, 0.3 * lever, 0.02 * end.spin_torque);  // of the smooth field
    EXPECT_NEAR(end.torque_z, -end.spin_torque, 1e-6 * end.spin_torque);
    EXPECT_NEAR(end.lateral_force_x, 0.0, 1e-6 * end.normal_force);
  }
}

/// Turned there and back the loop closes and wastes work; the way there is the way back, mirrored.
TEST(StaticPress, ATwistThereAndBackIsALoop) {
  PressSetup setup = press_at(8, {0.15}, ContactMode::coulomb);
  setup.protocol.friction = 0.3;
  setup.protocol.lateral_samples = 2;
  setup.protocol.program = {{1.5e-3, 0.01, 0.0}};
  for (const double angle : {0.08, -0.08, 0.08, -0.08})
    setup.protocol.program.push_back(
        {.indentation = 1.5e-3, .speed = 1.0, .move = meshes::StageMove::twist, .twist = angle});
  const auto outcome = lattice::run_static_press(setup);
  const auto rows = outcome.response.following();  // at half of each move and at its end
  ASSERT_EQ(rows.size(), 8U);
  EXPECT_EQ(rows[2].twist, 0.0);
  EXPECT_EQ(rows[2].stage, 3.0);
  const double most = rows[5].spin_torque;
  EXPECT_LT(rows[1].spin_torque, 1.8 * rows[0].spin_torque) << "it slips";
  EXPECT_NEAR(rows[3].spin_torque, -most, 0.02 * most);
  EXPECT_NEAR(rows[7].spin_torque, rows[3].spin_torque, 0.01 * most);
  EXPECT_NEAR(rows[6].spin_torque, -rows[4].spin_torque, 0.02 * most);
  EXPECT_GT(rows[4].spin_torque, 0.05 * most) << "through zero turned back from below";
}

/// Dragged and turned about a place beside it until all of it slides, it holds the force and the
/// moment that its own pressure makes of that place.
TEST(StaticPress, DraggedAndTurnedItIsOnItsLimitSurface) {
  PressSetup setup = press_at(8, {0.15}, ContactMode::coulomb);
  setup.protocol.friction = 0.1;
  setup.protocol.lateral_path = meshes::LateralPath::after;
  setup.protocol.lateral_samples = 1;
  for (const double away : {2e-3, 4e-3, 8e-3}) {
    setup.protocol.lateral = std::min(1.5 * away, setup.geometry.tip_radius);
    setup.protocol.twist = setup.protocol.lateral / away;
    const StaticOutcome outcome = lattice::run_static_press(setup);
    const PressSample& end = outcome.response.samples().back();
    const auto field = meshes::samples_of(outcome.contact).back();
    const meshes::LimitPoint held = meshes::limit_point(field, away, 0.5 * std::numbers::pi);
    EXPECT_NEAR(end.lateral_force_x, 0.1 * held.force, 0.03 * 0.1 * held.force) << away;
    EXPECT_NEAR(end.spin_torque, 0.1 * held.moment, 0.03 * 0.1 * held.moment) << away;
  }
}

/// Without friction the place is all that counts: a cylinder along y, turned by a right angle, is
/// one along x.
TEST(StaticPress, TheObstacleTurnsWithThePlane) {
  for (const Kinematics kinematics : {Kinematics::small, Kinematics::finite}) {
    PressSetup setup =
        press_at(5, {0.1}, ContactMode::frictionless, ModelKind::network, kinematics);
    setup.protocol.obstacle = {
        .shape = meshes::ObstacleShape::cylinder, .radius = 4e-3, .along = meshes::ObstacleAxis::x};
    const auto body = body_in_sectors(setup, 1);
    const PressSample along_x = lattice::run_static_press(setup, body).response.samples().back();
    setup.protocol.obstacle.along = meshes::ObstacleAxis::y;
    setup.protocol.twist = 0.5 * std::numbers::pi;
    setup.protocol.lateral_samples = 3;
    const PressSample turned = lattice::run_static_press(setup, body).response.samples().back();
    expect_same(turned, along_x, 1e-6, setup.geometry.rod_length);
  }
}

/// A plane that moves aside as it turns turns about another axis: about one far away it moves.
TEST(StaticPress, SticksToAPlaneThatTurnsAboutAnyAxis) {
  PressSetup setup = press_at(6, {0.1}, ContactMode::stick, ModelKind::network, Kinematics::finite);
  setup.protocol.lateral_path = meshes::LateralPath::after;
  setup.protocol.lateral_samples = 2;
  setup.protocol.twist = 0.02;
  const PressSample turned = last_sample(setup);
  setup.protocol.lateral = 2e-4;
  const PressSample both = last_sample(setup);
  setup.protocol.twist = 0.0;
  const PressSample moved = last_sample(setup);
  EXPECT_GT(turned.spin_torque, 0.0);
  EXPECT_NEAR(both.spin_torque, turned.spin_torque, 0.02 * turned.spin_torque);
  EXPECT_NEAR(both.lateral_force_x, moved.lateral_force_x, 0.02 * moved.lateral_force_x);
  setup.protocol.lateral = 0.0;
  setup.protocol.twist = -0.02;
  EXPECT_NEAR(last_sample(setup).spin_torque, -turned.spin_torque, 1e-4 * turned.spin_torque);
}

/// Whatever follows, the way down is that of the straight press to the last bit.
TEST(StaticPress, WhatFollowsThePressDoesNotChangeIt) {
  for (const Kinematics kinematics : {Kinematics::small, Kinematics::finite}) {
    PressSetup setup = press_at(5, {0.05, 0.1}, ContactMode::stick, ModelKind::network, kinematics);
    const auto body = body_in_sectors(setup, 2);
    const auto straight = lattice::run_static_press(setup, body).response;
    setup.protocol.lateral = 2e-4;
    setup.protocol.lateral_path = meshes::LateralPath::after;
    setup.protocol.lateral_samples = 2;
    const auto after = lattice::run_static_press(setup, body).response;
    ASSERT_EQ(after.pressing().size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(after.samples()[i].lateral_displacement, 0.0);
      EXPECT_EQ(after.samples()[i].normal_force, straight.samples()[i].normal_force);
      EXPECT_EQ(after.samples()[i].lateral_force_x, straight.samples()[i].lateral_force_x);
      EXPECT_EQ(after.samples()[i].torque_y, straight.samples()[i].torque_y);
      EXPECT_EQ(after.samples()[i].max_pressure, straight.samples()[i].max_pressure);
    }
  }
}

/// A tip that sticks is a linear spring laterally while the same points touch; sheared from first
/// touch on, the same place of the plane drags it less, for what touches late has moved less.
TEST(StaticPress, StuckItIsALinearSpringAside) {
  PressSetup setup = press_at(6, {0.1, 0.2}, ContactMode::stick);
  setup.protocol.lateral = 2e-6;
  setup.protocol.lateral_path = meshes::LateralPath::after;
  setup.protocol.lateral_samples = 4;
  const auto after = lattice::run_static_press(setup).response;
  const double end = after.sliding().back().lateral_force_x;
  EXPECT_GT(end, 0.0);
  for (int i = 1; i <= 4; ++i)
    EXPECT_NEAR(after.sliding()[std::size_t(i) - 1].lateral_force_x / end, 0.25 * i, 2e-3) << i;
  EXPECT_NEAR(after.samples()[1].lateral_force_x / end, 0.0, 1e-4);
  setup.protocol.lateral_path = meshes::LateralPath::diagonal;
  EXPECT_LT(last_sample(setup).lateral_force_x, 0.9 * end);
}

/// A grid turned by a right angle about an axis of its own is the same grid.
TEST(StaticPress, GridTurnedByARightAngleChangesNothing) {
  PressSetup setup = press_at(5, {0.1});
  const PressSample straight = last_sample(setup);
  setup.lattice.axes << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  const auto turned = lattice::run_static_press(setup);
  EXPECT_EQ(turned.sectors, 1);
  expect_same(turned.response.samples().back(), straight, 1e-7, setup.geometry.rod_length);
}

/// The published lattice touches with its pole particle alone for long; stuck or not hardly matters
/// then, and lateral forces vanish by symmetry.
TEST(StaticPress, PublishedLatticeIsPressedOnItsParticles) {
  const auto stick = lattice::run_static_press(
      press_at(8, {0.05, 0.1, 0.3}, ContactMode::stick, ModelKind::published));
  const auto free = lattice::run_static_press(
      press_at(8, {0.05, 0.1}, ContactMode::frictionless, ModelKind::published));
  EXPECT_EQ(stick.sectors, 1);
  EXPECT_EQ(stick.cells, 0U);
  for (std::size_t i = 0; i < 2; ++i) {
    const PressSample& s = stick.response.samples()[i];
    EXPECT_NEAR(s.normal_force, free.response.samples()[i].normal_force, 1e-6 * s.normal_force);
    EXPECT_NEAR(s.lateral_force_x, 0.0, 1e-8 * s.normal_force);
  }
  // The dynamic press of the same lattice at 1 cm/s (lattice/MEASUREMENTS.md): 0.57 and 19.86 gf.
  EXPECT_NEAR(stick.response.samples()[1].normal_force / gf, 0.57, 0.02);
  EXPECT_NEAR(stick.response.samples()[2].normal_force / gf, 19.86, 0.6);
}

TEST(StaticPress, ReportsAsItGoes) {
  const PressSetup setup = press_at(5, {0.02, 0.05}, ContactMode::stick);
  double last = 0.0;
  std::size_t seen = 0;
  const auto outcome = lattice::run_static_press(setup, [&](const StaticOutcome& now, double done) {
    EXPECT_GT(done, last - 1e-12);
    EXPECT_GE(now.response.samples().size(), seen);
    last = done;
    seen = now.response.samples().size();
    return true;
  });
  EXPECT_NEAR(last, 1.0, 1e-12);
  EXPECT_EQ(seen, 2U);
  EXPECT_EQ(outcome.response.samples()[0].indentation, 0.02 * cm);
  EXPECT_TRUE(std::isnan(outcome.response.samples()[0].time));
  std::size_t kept = 0;
  EXPECT_THROW(lattice::run_static_press(setup,
                                         [&](const StaticOutcome& now, double) {
                                           kept = now.response.samples().size();
                                           return kept == 0;
                                         }),
               meshes::Interrupted);
  EXPECT_EQ(kept, 1U);
}

TEST(StaticPress, RefusesBadInput) {
  const auto refused = [](const auto& spoil) {
    PressSetup setup = press_at(5, {0.1});
    spoil(setup);
    EXPECT_THROW(lattice::run_static_press(setup), meshes::InvalidInput);
  };
  refused([](PressSetup& s) { s.lattice.spacing = 0.003; });
  refused([](PressSetup& s) { s.protocol.twist = 2.0; });
  refused([](PressSetup& s) { s.protocol.tilt = 1.0; });
  refused([](PressSetup& s) { s.protocol.samples = {0.002, 0.001}; });
  refused([](PressSetup& s) { s.rubber.youngs_modulus = -1.0; });
  refused([](PressSetup& s) { s.lattice.constants.k1 = -1.0; });
  refused([](PressSetup& s) {
    s.lattice.model = ModelKind::published;
    s.lattice.axes << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  });
}

/// An exact tangent, steps no more accurate than they serve, few gradients for each.
TEST(StaticPress, TakesFewGradients) {
  const StaticOutcome outcome = lattice::run_static_press(press_at(8, {0.1, 0.2}));
  EXPECT_LE(outcome.newton_iterations, 20);
  EXPECT_LE(outcome.gradients, 160);
  EXPECT_LE(outcome.factorisations, 8);
  const StaticOutcome sticks =
      lattice::run_static_press(press_at(8, {0.1, 0.2}, ContactMode::stick));
  EXPECT_LE(sticks.newton_iterations, 60);
  EXPECT_LE(sticks.gradients, 350);
  EXPECT_LE(sticks.factorisations, 15);
}
