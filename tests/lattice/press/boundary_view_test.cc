#include "lattice/press/boundary_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lattice/press/press.h"
#include "lattice/press/static_press.h"
#include "tests/coarse_press.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fixtures;
using lattice::BoundaryView;
using lattice::FingerPicture;
using lattice::Kinematics;
using lattice::ModelKind;
using lattice::Moment;
using meshes::Vector3;

namespace {

/// Distance from the true outer surface: the hemisphere above z = 0, the cylinder below.
double off_surface(const Vector3& place, double radius) {
  return std::abs(Vector3(place.x(), place.y(), std::max(place.z(), 0.0)).norm() - radius);
}

}  // namespace

TEST(BoundaryView, LiesOnTheTrueSurfaceOfCutTips) {
  const meshes::Geometry geometry;
  for (const ModelKind kind : cell_models) {
    const lattice::LatticeModel model = tip(kind, Kinematics::small, 6);
    const BoundaryView view(model, geometry);
    EXPECT_GT(view.size(), 0.8 * double(model.boundary.size())) << name(kind);
    for (const Vector3& place : view.rest()) EXPECT_LT(off_surface(place, 0.01), 1e-9);
    for (const auto& [i, j] : view.springs()) {
      ASSERT_LT(std::size_t(std::max(i, j)), view.size());
      EXPECT_NE(i, j);
      const double length = (view.rest()[std::size_t(i)] - view.rest()[std::size_t(j)]).norm();
      EXPECT_LT(length, 2.5 * model.spacing());
    }
  }
}

TEST(BoundaryView, ShowsEveryBoundaryParticleOfThePublishedModel) {
  const lattice::LatticeModel model = tip(ModelKind::published, Kinematics::finite, 6);
  const BoundaryView view(model, {});
  ASSERT_EQ(view.size(), model.boundary.size());
  for (std::size_t p = 0; p < view.size(); ++p)
    EXPECT_EQ(view.rest()[p], model.rest_position(model.boundary[p]));
  for (const auto& [i, j] : view.springs()) {
    const Vector3 spring = view.rest()[std::size_t(i)] - view.rest()[std::size_t(j)];
    EXPECT_NEAR(spring.norm(), model.spacing(), 1e-12);
  }
}

TEST(BoundaryView, FollowsALinearMotionExactly) {
  // Trilinear weights reproduce linear fields; the grid is turned against the tip.
  lattice::LatticeSettings settings = settings_for(ModelKind::hookean, Kinematics::small, 6);
  settings.axes = lattice::rotation_by({0.2, -0.4, 0.7}).toRotationMatrix();
  const lattice::LatticeModel model = lattice::build_tip({}, {}, settings);
  const BoundaryView view(model, {});
  Eigen::Matrix3d gradient;
  gradient << 0.1, -0.02, 0.03, 0.04, -0.2, 0.01, 0.05, 0.06, 0.15;
  const Vector3 shift(1e-3, -2e-3, 3e-3);
  lattice::State state(model);
  for (const std::size_t i : model.particles) {
    const Vector3 moved = gradient * model.rest_position(i) + shift;
    state.displacement.set(i, model.grid.axes.transpose() * moved);
  }
  const std::vector<Vector3> places = view.deformed(state);
  for (std::size_t p = 0; p < view.size(); ++p) {
    const Vector3 wanted = view.rest()[p] + gradient * view.rest()[p] + shift;
    // Higher up on the sleeve a particle may be drawn beside itself, where no point is tied to it.
    if (view.rest()[p].z() < -0.005) continue;
    EXPECT_LT((places[p] - wanted).norm(), 1e-12);
  }
}

TEST(PressPictures, SnapshotsAreBeforeContactAtTouchAtHalfDepthAndAtTheEnd) {
  const lattice::PressSetup setup = coarse_press(2e-3);
  const lattice::PressOutcome outcome = lattice::run_press(setup);
  ASSERT_EQ(outcome.snapshots.size(), 4u);
  const auto& [before, touch, half, full] = std::tie(outcome.snapshots[0], outcome.snapshots[1],
                                                     outcome.snapshots[2], outcome.snapshots[3]);
  // How far the rod gets, at most, in the step that begins at a depth and the one before [m].
  const double step = 2.0 * setup.protocol.speed * outcome.step.step;
  EXPECT_NEAR(before.indentation, -1e-3, step);
  EXPECT_EQ(std::ranges::count(before.held, 1), 0);
  EXPECT_NEAR(touch.time, outcome.first_touch_time, 1e-12);
  EXPECT_GT(std::ranges::count(touch.held, 1), 0);
  EXPECT_NEAR(half.indentation, 0.5e-3, step);
  EXPECT_NEAR(full.indentation, 1e-3, step);
  EXPECT_NEAR(full.on_rod.force.norm(), outcome.response.samples().back().normal_force, 1e-3);
  for (const FingerPicture& picture : outcome.snapshots) {
    ASSERT_EQ(picture.boundary.size(), outcome.boundary_rest.size());
    // The rod moves along its axis, by what the pole is nearer to the plane.
    EXPECT_NEAR(picture.rod.position.z(), picture.indentation + setup.protocol.clearance, 1e-6);
    for (std::size_t p = 0; p < picture.boundary.size(); ++p)
      EXPECT_GT(picture.plane.gap(picture.boundary[p]), -0.02e-3) << picture.time;
  }
}

// The same shapes as those of a press so slow that it hardly differs from an equilibrium, computed
// on a quarter and on the whole tip. In motion the way begins at the clearance.
TEST(PressPictures, AtRestTheShapesAreThoseOfASlowPress) {
  lattice::PressSetup setup = coarse_press();
  setup.protocol.mode = meshes::DriveMode::quasi_static;
  setup.protocol.speed = 0.01;
  setup.protocol.samples = {0.2e-3, 0.4e-3, 0.6e-3, 1e-3};
  const lattice::PressOutcome moving = lattice::run_press(setup);
  setup.protocol.mode = meshes::DriveMode::equilibrium;
  const lattice::StaticOutcome resting = lattice::run_static_press(setup, {}, true);
  ASSERT_EQ(resting.sectors, 4);
  EXPECT_EQ(resting.boundary_rest, moving.boundary_rest);
  EXPECT_EQ(resting.boundary_springs, moving.boundary_springs);
  ASSERT_EQ(resting.snapshots.size(), 3u);
  EXPECT_EQ(resting.snapshots[0].moment, Moment::first_touch);
  EXPECT_EQ(resting.snapshots[0].boundary, resting.boundary_rest);
  EXPECT_EQ(std::ranges::count(resting.snapshots[0].held, 1), 0);
  EXPECT_EQ(resting.snapshots[1].moment, Moment::half_depth);
  EXPECT_EQ(resting.snapshots[1].indentation, 0.6e-3) << "the first sample from half depth on";
  const auto &end = resting.snapshots[2], &slow = moving.snapshots.back();
  EXPECT_EQ(end.moment, Moment::end);
  EXPECT_EQ(end.indentation, 1e-3);
  EXPECT_TRUE(std::isnan(end.time));
  EXPECT_NEAR(end.on_rod.force.norm(), resting.response.samples().back().normal_force, 1e-12);
  const Vector3 clearance = setup.protocol.clearance * Vector3::UnitZ();
  const double step = setup.protocol.speed * moving.step.step;  // beyond the depth, at most [m]
  EXPECT_LT((end.rod.position + clearance - slow.rod.position).norm(), 1.001 * step);
  EXPECT_LT((end.plane.point + clearance - slow.plane.point).norm(), 1e-9);
  for (std::size_t p = 0; p < end.boundary.size(); ++p)
    EXPECT_LT((end.boundary[p] + clearance - slow.boundary[p]).norm(), 0.03e-3) << p;
  EXPECT_NEAR(double(std::ranges::count(end.held, 1)), double(std::ranges::count(slow.held, 1)),
              0.1 * double(std::ranges::count(slow.held, 1)));
  setup.protocol.tilt = 1e-9;  // leaves but one mirror plane
  const lattice::StaticOutcome half = lattice::run_static_press(setup, {}, true);
  ASSERT_EQ(half.sectors, 2);
  for (std::size_t p = 0; p < end.boundary.size(); ++p)
    EXPECT_LT((end.boundary[p] - half.snapshots.back().boundary[p]).norm(), 1e-8) << p;
}

TEST(PressPictures, OfAnyModelTheRestingTipTouchesThePlaneThatTiltedItAndMovedAlongIt) {
  for (const ModelKind kind : {ModelKind::published, ModelKind::central, ModelKind::network}) {
    lattice::PressSetup setup = coarse_press();
    setup.lattice = settings_for(kind, Kinematics::finite, 5);
    setup.protocol.mode = meshes::DriveMode::equilibrium;
    setup.protocol.tilt = 0.1;
    setup.protocol.lateral = 0.2e-3;
    const lattice::StaticOutcome outcome = lattice::run_static_press(setup, {}, true);
    const auto& end = outcome.snapshots.back();
    EXPECT_NEAR(end.rod.position.dot(end.plane.normal), -setup.protocol.depth, 1e-12);
    double lowest = 1.0;
    for (const Vector3& place : end.boundary) lowest = std::min(lowest, end.plane.gap(place));
    EXPECT_NEAR(lowest, 0.0, 0.05e-3) << name(kind);
    EXPECT_GT(std::ranges::count(end.held, 1), 0) << name(kind);
    EXPECT_TRUE(lattice::run_static_press(setup).snapshots.empty()) << "not asked for";
  }
}

TEST(PressPictures, AFilmIsEvenInTimeFromStartToEnd) {
  const lattice::PressSetup setup = coarse_press(2e-3);
  std::vector<double> times;
  std::size_t places = 0;
  const lattice::PressFilm film{9, [&](const BoundaryView& view, const FingerPicture& picture) {
                                  places = view.size();
                                  EXPECT_EQ(picture.boundary.size(), places);
                                  times.push_back(picture.time);
                                }};
  const lattice::PressOutcome outcome = lattice::run_press(setup, {}, film);
  ASSERT_EQ(times.size(), 9u);
  EXPECT_EQ(places, outcome.boundary_rest.size());
  EXPECT_EQ(times.front(), 0.0);
  EXPECT_NEAR(times.back(), outcome.simulated_time, 1e-3);
  for (std::size_t i = 1; i < times.size(); ++i)
    EXPECT_NEAR(times[i] - times[i - 1], outcome.simulated_time / 8.0, 1e-3);
}
