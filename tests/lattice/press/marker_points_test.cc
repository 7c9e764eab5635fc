#include "lattice/press/marker_points.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "lattice/press/press.h"
#include "lattice/press/static_press.h"
#include "lattice/statics/cut_lattice.h"
#include "meshes/press/markers.h"
#include "tests/fingers.h"
#include "tests/lattice/presses.h"

using namespace fingertip;
using lattice::MarkerPoints;
using lattice::ModelKind;
using lattice::PressSetup;
using meshes::MarkerRow;
using meshes::Vector3;

namespace {

/// On the dome, in it, on the sleeve and its end.
std::vector<Vector3> scattered() {
  const auto shape = meshes::shape_of({});
  std::vector<Vector3> places = marker_grid(*shape, 1.7e-3, 0.0);
  for (const Vector3& inside : marker_grid(*shape, 2.3e-3, 2e-3)) places.push_back(inside);
  for (const double angle : {0.1, 2.0, 3.9, 5.5})
    for (const double radius : {5e-3, 7.1e-3, 10e-3})
      for (const double height : {-15e-3, -6.3e-3, 0.0})
        places.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
  return places;
}

PressSetup marked(const presses::Press& press) {
  PressSetup setup = presses::setup_of(press);
  setup.protocol.markers = scattered();
  return setup;
}

/// How far markers are off where particles are displaced by gradient X + shift, over the radius.
double patch_error(const PressSetup& setup, int sectors, const Eigen::Matrix3d& gradient,
                   const Vector3& shift) {
  const std::vector<Vector3> rest = lattice::static_body(setup, sectors).rest;
  const MarkerPoints points(setup, sectors, rest);
  const auto displacements = points.displacements(
      [&](std::uint32_t particle) -> Vector3 { return gradient * rest[particle] + shift; });
  double worst = 0.0;
  for (std::size_t i = 0; i < displacements.size(); ++i)
    worst =
        std::max(worst, (displacements[i] - gradient * setup.protocol.markers[i] - shift).norm());
  return worst / setup.geometry.tip_radius;
}

/// Also where the surface has cut off a cell, or the staircase ends inside, in any part of the tip
/// whose mirror images the displacement has.
TEST(MarkerPoints, ReproduceALinearDisplacement) {
  const Eigen::Matrix3d any =
      (Eigen::Matrix3d() << 0.3, -0.2, 0.5, 0.1, 0.7, -0.4, 0.6, 0.25, -0.9).finished();
  Eigen::Matrix3d in_half = any;
  in_half(0, 1) = in_half(1, 0) = in_half(1, 2) = in_half(2, 1) = 0.0;
  const Eigen::Matrix3d in_quarter = any.diagonal().asDiagonal();
  const Vector3 up = 1e-3 * Vector3::UnitZ(), aside = 2e-3 * Vector3::UnitX();
  PressSetup setup = marked({.per_radius = 7});
  EXPECT_LT(patch_error(setup, 4, in_quarter, up), 1e-14);
  EXPECT_LT(patch_error(setup, 2, in_half, up + aside), 1e-14);
  EXPECT_LT(patch_error(setup, 1, any, up + aside), 1e-14);
  setup.lattice.axes = lattice::rotation_by({0.2, -0.4, 0.7}).toRotationMatrix();
  setup.lattice.offset = {0.3, -0.1, 0.4};
  EXPECT_LT(patch_error(setup, 1, any, up + aside), 1e-14);
  EXPECT_LT(
      patch_error(marked({.model = ModelKind::published, .per_radius = 12}), 1, any, up + aside),
      1e-14);
  // A displacement that is no mirror image of itself shows.
  EXPECT_GT(patch_error(marked({}), 4, any, up), 0.1);
}

/// Largest distance between two presses' markers, over the indentation [1].
double difference(const std::vector<MarkerRow>& some, const std::vector<MarkerRow>& others) {
  EXPECT_EQ(some.size(), others.size());
  EXPECT_FALSE(some.empty());
  double worst = 0.0;
  for (std::size_t i = 0; i < std::min(some.size(), others.size()); ++i) {
    EXPECT_EQ(some[i].indentation, others[i].indentation);
    EXPECT_EQ(some[i].marker, others[i].marker);
    worst = std::max(worst,
                     (some[i].displacement - others[i].displacement).norm() / some[i].indentation);
  }
  return worst;
}

TEST(StaticPress, MarkersOfAPartAreThoseOfTheWhole) {
  for (const auto contact : {meshes::ContactMode::frictionless, meshes::ContactMode::stick})
    for (const int sectors : {4, 2}) {
      PressSetup setup = marked({.contact = contact, .samples = {0.6e-3, 1.2e-3}});
      if (sectors == 2) setup.protocol.tilt = 0.1;
      const auto in_parts = [&](int parts) {
        return lattice::run_static_press(
                   setup, build_cut_tip(setup.geometry, setup.rubber, setup.lattice, parts))
            .markers;
      };
      // What sticks is looked for to 1e-5 of the forces.
      EXPECT_LT(difference(in_parts(sectors), in_parts(1)),
                contact == meshes::ContactMode::stick ? 1e-5 : 1e-9)
          << sectors;
    }
}

/// The pole goes with the plane, what is held stays, and what is sheared leans after the plane.
TEST(StaticPress, MarkersGoWithPlaneAndRod) {
  PressSetup setup = presses::setup_of({.per_radius = 12, .samples = {1e-3}});
  setup.protocol.lateral = 0.4e-3;
  setup.protocol.lateral_path = meshes::LateralPath::after;
  setup.protocol.lateral_samples = 1;
  setup.protocol.markers = {{0.0, 0.0, 10e-3}, {0.0, 0.0, 5e-3}, {0.0, 5e-3, -8e-3}};
  const auto rows = lattice::run_static_press(setup).markers;
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_NEAR((rows[0].displacement - Vector3(0.0, 0.0, -1e-3)).norm(), 0.0, 0.02e-3);
  EXPECT_EQ(rows[3].sample, 2);
  EXPECT_NEAR((rows[3].displacement - Vector3(0.4e-3, 0.0, -1e-3)).norm(), 0.0, 0.02e-3);
  for (const std::size_t held : {1u, 2u, 4u, 5u})
    EXPECT_NEAR(rows[held].displacement.norm(), 0.0, 0.02e-3);
}

/// A block held below and pressed by a plane that sticks lies between two plates that hold its
/// faces: it is its own mirror image across its middle, seen from there. At large strain sides that
/// bulge fold onto the plane, not onto the bond.
TEST(StaticPress, ABlockBetweenPlatesIsItsOwnMirrorImage) {
  const double half = 40e-3;
  PressSetup setup = presses::setup_of({.samples = {4e-3, 14.6e-3}});
  setup.geometry = meshes::Geometry::of_solid(
      std::make_shared<meshes::Solid>(fingers::box({-half, -half, 0.0}, {half, half, 2.0 * half}),
                                      meshes::Region{{{2, true, 1e-6}}}));
  setup.lattice.spacing = 8e-3;
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  for (const double x : {3e-3, 17e-3, 35e-3})
    for (const double y : {-33e-3, 11e-3})
      for (const double z : {4e-3, 15e-3, 31e-3}) {
        setup.protocol.markers.emplace_back(x, y, z);
        setup.protocol.markers.emplace_back(x, y, 2.0 * half - z);
      }
  for (const auto& [model, within] :
       {std::pair{ModelKind::hookean, 1e-4}, {ModelKind::network, 5e-3}}) {
    setup.lattice.model = model;
    setup.lattice.kinematics =
        model == ModelKind::hookean ? lattice::Kinematics::small : lattice::Kinematics::finite;
    const auto rows = lattice::run_static_press(setup).markers;
    ASSERT_EQ(rows.size(), 2 * setup.protocol.markers.size());
    for (std::size_t i = 0; i < rows.size(); i += 2) {
      Vector3 image = rows[i + 1].displacement;
      image.z() = -rows[i].indentation - image.z();
      EXPECT_LT((rows[i].displacement - image).norm(), within * rows[i].indentation) << i;
    }
  }
}

/// Slow enough for inertia to be nothing: the same displacements seen from a rod that moves, also
/// where it comes aslant.
TEST(MovingPress, HasTheMarkersOfTheStaticOne) {
  for (const double tilt : {0.0, 0.15}) {
    PressSetup setup =
        marked({.contact = meshes::ContactMode::frictionless, .samples = {0.5e-3, 1e-3}});
    setup.protocol.tilt = tilt;
    setup.protocol.speed = 2e-3;
    const auto still = lattice::run_static_press(setup).markers;
    setup.protocol.mode = meshes::DriveMode::quasi_static;
    const auto moving = lattice::run_press(setup);
    EXPECT_LT(difference(moving.markers, still), 0.02) << tilt;
    for (const MarkerRow& row : moving.markers)
      EXPECT_EQ(moving.response.samples()[std::size_t(row.sample - 1)].indentation,
                row.indentation);
  }
}

}  // namespace
