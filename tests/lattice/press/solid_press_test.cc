// Presses of triangulated solids.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "lattice/press/press.h"
#include "lattice/press/press_task.h"
#include "lattice/press/static_press.h"
#include "tests/fingers.h"
#include "tests/lattice/presses.h"

using namespace fingertip;
using lattice::ModelKind;
using lattice::PressSetup;
using meshes::ContactMode;
using meshes::DriveMode;
using meshes::Geometry;

namespace {

PressSetup press_of(const Geometry& geometry, ModelKind model, double per_radius = 8) {
  return presses::setup_of({.model = model,
                            .per_radius = per_radius * geometry.tip_radius / 0.01,
                            .contact = ContactMode::frictionless,
                            .samples = {1e-3, 2e-3, 3e-3},
                            .geometry = geometry});
}

TEST(SolidPress, TrianglesOfTheDomeAreTheDomeAtRest) {
  const Geometry solid = fingers::solid_dome();
  for (const double tilt : {0.0, 0.2}) {
    PressSetup dome = press_of(Geometry{}, ModelKind::hookean);
    dome.protocol.tilt = tilt;
    if (tilt != 0.0) {
      dome.protocol.contact = ContactMode::stick;
      dome.protocol.samples = {dome.protocol.depth = 5e-4};
    }
    PressSetup triangles = dome;
    triangles.geometry = solid;
    const auto expected = lattice::run_static_press(dome).response.samples();
    const auto found = lattice::run_static_press(triangles).response.samples();
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      presses::expect_same_load(found[i], expected[i], 5e-3, 0.03);
      EXPECT_NEAR(found[i].lateral_force_y, 0.0, 1e-3 * expected[i].normal_force);
    }
  }
}

/// Facets are their own mirror images but for round-off, and so are points on them.
TEST(SolidPress, OfAPartIsThatOfTheWhole) {
  for (const double tilt : {0.0, 0.15}) {
    PressSetup setup = press_of(fingers::solid_dome(50, 32), ModelKind::hookean, 8.0);
    setup.protocol.tilt = tilt;
    setup.protocol.contact = ContactMode::stick;
    setup.protocol.samples = {setup.protocol.depth = 1e-3};
    const auto part = lattice::run_static_press(setup),
               whole = lattice::run_static_press(
                   setup, build_cut_tip(setup.geometry, setup.rubber, setup.lattice, 1));
    EXPECT_EQ(part.sectors, tilt == 0.0 ? 4 : 2);
    EXPECT_EQ(whole.sectors, 1);
    EXPECT_NEAR(part.volume / whole.volume, 1.0, 1e-9);
    const auto &found = part.response.samples().back(), &all = whole.response.samples().back();
    EXPECT_NEAR(found.normal_force / all.normal_force, 1.0, 1e-6);
    EXPECT_NEAR(found.lateral_force_x, all.lateral_force_x, 1e-6 * all.normal_force);
    EXPECT_NEAR(found.contact_radius / all.contact_radius, 1.0, 1e-6);
  }
  // What is no mirror image is whole.
  PressSetup odd = press_of(fingers::solid_dome(51, 32), ModelKind::hookean, 8.0);
  EXPECT_EQ(lattice::moving_sectors(odd), 2);
}

/// A pad in a cup up to its face, as triangles and as a profile, under a ball.
TEST(SolidPress, APadGluedAtItsSideIsItsProfile) {
  constexpr double radius = 8e-3, height = 8e-3;
  constexpr std::size_t sectors = 96;
  using enum meshes::ProfileSurface;
  using enum meshes::ProfileCurve;
  meshes::TriangleMesh mesh =
      fingers::revolved({{0.0, 0.0}, {radius, 0.0}, {radius, height}, {0.0, height}}, int(sectors));
  mesh.faces.assign(mesh.triangles.size(), mesh.face_number("cup"));
  std::fill(mesh.faces.end() - sectors, mesh.faces.end(), -1);  // the face
  PressSetup profile = press_of(Geometry::of_profile({{radius, 0.0, bond, straight},
                                                      {radius, height, contact, straight},
                                                      {0.0, height, axis, straight},
                                                      {0.0, 0.0, bond, straight}}),
                                ModelKind::hookean, 10.0);
  profile.protocol.obstacle = {.shape = meshes::ObstacleShape::sphere, .radius = 6e-3};
  profile.protocol.samples = {4e-4, 8e-4};
  profile.protocol.depth = 8e-4;
  PressSetup triangles = profile;
  triangles.geometry = Geometry::of_solid(
      std::make_shared<meshes::Solid>(mesh, meshes::Region{}, std::vector<std::string>{"cup"}));
  EXPECT_NEAR(triangles.geometry.thickness(), height, 1e-15);
  const auto expected = lattice::run_static_press(profile).response.samples(),
             found = lattice::run_static_press(triangles).response.samples();
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i].normal_force / expected[i].normal_force, 1.0, 0.01);
}

/// Line contact: a slice of a block, 2 x 1 and glued below, under a cylinder along the slice. With
/// nu = 0 its ends stay flat by themselves, so that however thin it is the plane problem is exact:
/// the half width of the contact is a = 2 sqrt(P'R/(pi E)) (Hertz), and the indentation
///   pi E d/P' = c - 2 ln(a/H)
/// has no limit for a block without end (Johnson 1985, ch. 5.6), which leaves c to the block. For
/// this one the continuum of the project tells 1.697 (20 mm high, R = 20 mm, 0.05 to 0.4 mm deep:
/// 1.691 to 1.704), its largest pressure Hertz's sqrt(P'E/(pi R)) within 0.5 % at 0.4 mm.
TEST(SolidPress, ACylinderOnABlockIsHertzsLineContact) {
  constexpr double height = 0.02, spacing = height / 32, width = 4 * spacing, radius = 0.02;
  const auto slice = std::make_shared<meshes::Solid>(
      fingers::box({-height, -0.5 * width, 0.0}, {height, 0.5 * width, height}),
      meshes::Region{{{2, true, 1e-6 * height}}});
  PressSetup press = press_of(Geometry::of_solid(slice, -0.01), ModelKind::hookean);
  press.rubber.shear_modulus = 0.5 * press.rubber.youngs_modulus;
  press.lattice.spacing = spacing;
  press.lattice.constants = lattice::hookean_constants(press.rubber, spacing);
  press.protocol.obstacle = {.shape = meshes::ObstacleShape::cylinder, .radius = radius};
  press.protocol.samples = {1e-4, 2e-4, 4e-4};
  press.protocol.depth = 4e-4;
  const double modulus = std::numbers::pi * press.rubber.youngs_modulus;
  const auto outcome = lattice::run_static_press(press);
  for (const auto& sample : outcome.response.samples()) {
    const double line = sample.normal_force / width,
                 half_width = 2.0 * std::sqrt(line * radius / modulus);
    // That constant within a hundredth of the whole.
    const double compliance = modulus * sample.indentation / line;
    EXPECT_NEAR(compliance + 2.0 * std::log(half_width / height), 1.697, 0.01 * compliance)
        << sample.indentation;
    // The area that touches, as a disc of equal area.
    const double area = std::numbers::pi * std::pow(sample.contact_radius, 2);
    EXPECT_NEAR(area / width, 2.0 * half_width, 2.0 * spacing) << sample.indentation;
  }
}

/// A bridge upside down: two pads of 4 x 10 mm, whose area is that of the contact, at rest and in
/// motion.
TEST(SolidPress, TwoPadsAreNoRoundSpot) {
  constexpr double mm = 1e-3;
  meshes::TriangleMesh mesh;
  constexpr std::array<std::array<double, 2>, 8> outline{
      {{-10, 0}, {10, 0}, {10, 10}, {6, 10}, {6, 4}, {-6, 4}, {-6, 10}, {-10, 10}}};
  for (const double y : {-5.0, 5.0})
    for (const auto& [x, z] : outline) mesh.vertices.emplace_back(x * mm, y * mm, z * mm);
  for (const auto& [a, b, c] :
       {std::array{0, 1, 4}, {1, 2, 3}, {1, 3, 4}, {0, 4, 5}, {0, 5, 6}, {0, 6, 7}}) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({c + 8, b + 8, a + 8});
  }
  for (int a = 0; a < 8; ++a) {
    const int b = (a + 1) % 8;
    mesh.triangles.push_back({b, a, a + 8});
    mesh.triangles.push_back({b, a + 8, b + 8});
  }
  PressSetup press = press_of(Geometry::of_solid(std::make_shared<meshes::Solid>(
                                  mesh, meshes::Region{{{2, true, 0.5 * mm}}})),
                              ModelKind::hookean);
  press.lattice.spacing = 1.0 * mm;
  press.lattice.constants = lattice::hookean_constants(press.rubber, press.lattice.spacing);
  press.protocol.samples = {0.1 * mm, 0.2 * mm};
  press.protocol.depth = 0.2 * mm;
  const auto expect_pads = [](const meshes::PressResponse& response) {
    for (const auto& sample : response.samples()) {
      EXPECT_GT(sample.normal_force, 0.0);
      EXPECT_NEAR(sample.contact_radius, std::sqrt(80.0 / std::numbers::pi) * mm, 0.025 * mm);
      EXPECT_NEAR(sample.mean_pressure, sample.normal_force / (80.0 * mm * mm),
                  0.015 * sample.mean_pressure);
    }
    // The rod feels the pads later than the plane does.
    const auto& last = response.samples().back();
    EXPECT_GT(last.max_pressure, last.mean_pressure);
    EXPECT_LT(last.max_pressure, 2.0 * last.mean_pressure);
  };
  expect_pads(lattice::run_static_press(press).response);
  press.protocol.mode = DriveMode::quasi_static;
  expect_pads(lattice::run_press(press).response);
}

/// A turned grid cuts the same rubber.
TEST(SolidPress, TurnedGridsAgree) {
  PressSetup aligned = press_of(fingers::solid_dome(), ModelKind::hookean);
  aligned.protocol.samples = {aligned.protocol.depth = 2e-3};
  PressSetup turned = aligned;
  turned.lattice.axes = Eigen::AngleAxisd(0.5, meshes::Vector3(0.0, 0.6, 0.8)).toRotationMatrix();
  const auto of = [](const PressSetup& setup) {
    const auto outcome = lattice::run_static_press(setup);
    EXPECT_NEAR(outcome.volume / outcome.exact_volume, 1.0, 1e-5);  // small shares are left out
    return outcome.response.samples().back().normal_force;
  };
  const double force = of(aligned);
  EXPECT_NEAR(of(turned), force, 0.03 * force);
}

TEST(SolidPress, MovesAsTheDomeDoes) {
  const Geometry solid = fingers::solid_dome();
  for (const ModelKind model : {ModelKind::hookean, ModelKind::published}) {
    PressSetup dome = press_of(Geometry{}, model);
    dome.protocol.contact = ContactMode::stick;
    dome.protocol.mode = DriveMode::quasi_static;
    dome.protocol.samples = {1e-3, 2e-3};
    dome.protocol.depth = 2e-3;
    // No grid point may lie on a surface, which facets do not reach.
    dome.lattice.offset = {0.21, 0.13, 0.37};
    PressSetup triangles = dome;
    triangles.geometry = solid;
    const auto expected = lattice::run_press(dome), found = lattice::run_press(triangles);
    const double depth = dome.protocol.depth, force = expected.response.normal_force_at(depth);
    EXPECT_NEAR(found.response.normal_force_at(depth), force,
                (model == ModelKind::hookean ? 5e-3 : 0.03) * force)
        << name(model);
    EXPECT_LT(found.momentum_defect, 1e-9);
  }
}

}  // namespace
