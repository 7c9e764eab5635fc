#include "meshes/shape/solid.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <random>

#include "meshes/cells/cut_cells.h"
#include "meshes/cells/surface_points.h"
#include "tests/expectations.h"
#include "tests/fingers.h"

using namespace fingertip::meshes;

namespace {

using std::numbers::pi;
using enum ProfileSurface;

const Region base = {{{2, true, 0.0}}};

/// Everything that is said of a surface that is no finger.
void expect_refused(const TriangleMesh& mesh, const Region& bond,
                    const std::vector<std::string>& words) {
  EXPECT_TRUE(refuses<InvalidInput>([&] { const Solid solid(mesh, bond); }, words));
}

TriangleMesh joined(TriangleMesh a, const TriangleMesh& b) {
  const int first = int(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& [i, j, k] : b.triangles)
    a.triangles.push_back({first + i, first + j, first + k});
  return a;
}

TriangleMesh inside_out(TriangleMesh mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  return mesh;
}

const Vector3 low(-0.006, -0.005, 0.0), high(0.004, 0.007, 0.02);

/// Volume and first moments by the divergence theorem.
Eigen::Vector4d total_of(const TriangleMesh& mesh) {
  Eigen::Vector4d total = Eigen::Vector4d::Zero();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vector3 a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
    const double volume = a.dot(b.cross(c)) / 6.0;  // of the tetrahedron with the origin
    total[0] += volume;
    total.tail<3>() += volume * (a + b + c) / 4.0;
  }
  return total;
}

TEST(Solid, MeasuresABox) {
  const Solid solid(fingers::box(low, high), {{{2, true, 0.0012}, {0, false, 0.0}}});
  EXPECT_NEAR(solid.volume(), 0.01 * 0.012 * 0.02, 1e-18);
  // Of the base, the sides y and the side x what lies within x > 0, z < 1.2 mm.
  const double bond = 0.004 * 0.012 + 2.0 * 0.004 * 0.0012 + 0.012 * 0.0012;
  EXPECT_NEAR(solid.area(ProfileSurface::bond), bond, 1e-16);
  EXPECT_NEAR(solid.area(contact) + bond, 2.0 * (1.2e-4 + 2e-4 + 2.4e-4), 1e-16);
  EXPECT_EQ(solid.pole(), 0.02);
  EXPECT_EQ(solid.lowest(), 0.0);
  EXPECT_NEAR(solid.bond_top(), 0.0012, 1e-15);
  EXPECT_NEAR(solid.reach(0.3), std::cos(0.3) * 0.02 + std::sin(0.3) * 0.004, 1e-15);
  EXPECT_NEAR(solid.reach(-0.3), std::cos(0.3) * 0.02 + std::sin(0.3) * 0.006, 1e-15);
  EXPECT_NEAR(solid.signed_distance({0.0, 0.0, 0.003}), -0.003, 1e-15);
  EXPECT_NEAR(solid.signed_distance({0.0, 0.0, 0.024}), 0.004, 1e-15);
  const NearestPoint found = solid.nearest(contact, {-0.01, 0.0, 0.01});
  EXPECT_NEAR(found.distance, 0.004, 1e-15);
  EXPECT_NEAR((found.normal + Vector3::UnitX()).norm(), 0.0, 1e-12);
  EXPECT_TRUE(std::isinf(solid.nearest(free, {0.0, 0.0, 0.0}).distance));
  // No wall is thinner than the finger is high: its sides are far apart.
  EXPECT_NEAR(solid.wall(), 0.02 - 0.0012, 1e-15);
}

/// In a cup up to its face; a plate in a frame.
TEST(Solid, GluedAtTheSideItIsAsThickAsAlongTheAxis) {
  const Region sides = {
      {{0, true, low.x()}}, {{0, false, high.x()}}, {{1, true, low.y()}}, {{1, false, high.y()}}};
  Region cup = sides;
  cup.push_back({{2, true, low.z()}});
  for (const Region& held : {sides, cup}) {
    const Solid solid(fingers::box(low, high), held);
    EXPECT_EQ(solid.pole(), high.z());
    EXPECT_NEAR(solid.pole() - solid.bond_top(), high.z() - low.z(), 1e-15);
  }
  EXPECT_THROW_SAYING(Solid(fingers::box(low, high), {{{2, false, high.z()}}}), InvalidInput,
                      "geometry.bond");
}

TEST(Solid, OfTheDomeIsTheDome) {
  const Geometry dome, geometry = fingers::solid_dome();
  const Solid& solid = *geometry.solid;
  EXPECT_NEAR(double(fingers::dome_surface().triangles.size()), 20000.0, 1000.0);
  EXPECT_NEAR(geometry.tip_radius, dome.tip_radius, 1e-15);
  EXPECT_NEAR(geometry.thickness(), dome.thickness(), 1e-15);
  EXPECT_NEAR(geometry.lowest(), dome.lowest(), 1e-15);
  EXPECT_NEAR(geometry.tip_volume() / dome.tip_volume(), 1.0, 2e-3);
  EXPECT_NEAR(geometry.rod_radius, dome.rod_radius, 1e-5);
  EXPECT_EQ(geometry.rod_endpoint(), dome.rod_endpoint());
  EXPECT_NEAR(solid.area(contact) / (surface_area(dome, ProfileSurface::contact) +
                                     surface_area(dome, ProfileSurface::free)),
              1.0, 2e-3);
  EXPECT_NEAR(solid.area(ProfileSurface::bond) / surface_area(dome, ProfileSurface::bond), 1.0,
              2e-3);
  EXPECT_NEAR(solid.wall() / 0.005, 1.0, 5e-3);
  EXPECT_NEAR(solid.pole_radius() / dome.tip_radius, 1.0, 0.02);
  for (const double tilt : {0.0, 0.3, -0.7}) EXPECT_NEAR(solid.reach(tilt), dome.tip_radius, 1e-5);
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> place(-0.02, 0.02);
  for (int i = 0; i < 2000; ++i) {
    const Vector3 w(place(generator), place(generator), place(generator));
    EXPECT_NEAR(solid.signed_distance(w), dome.signed_distance(w), 1.2e-5) << w.transpose();
  }
}

/// Volume and centre of the cells are the polyhedron's own, on aligned and turned grids, and every
/// cell holds what it can.
TEST(SolidCells, AddUpExactly) {
  const Geometry bodies[] = {
      fingers::solid_dome(),
      Geometry::of_solid(std::make_shared<Solid>(fingers::box(low, high), base)),
      Geometry::of_solid(std::make_shared<Solid>(
          joined(fingers::box(low, high),
                 inside_out(fingers::box({-0.003, -0.003, 0.004}, {0.002, 0.003, 0.015}))),
          base))};
  for (const Geometry& geometry : bodies)
    for (const bool turned : {false, true})
      for (const double spacing : {5e-4, 3.7e-4}) {
        Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
        if (turned)
          axes =
              (Eigen::AngleAxisd(0.4, Vector3::UnitX()) * Eigen::AngleAxisd(1.1, Vector3::UnitZ()))
                  .toRotationMatrix();
        const CubicGrid grid = covering_grid(
            geometry, spacing, turned ? Vector3(0.3, 0.1, 0.7) : Vector3::Zero(), 1, axes);
        Eigen::Vector4d sum = Eigen::Vector4d::Zero();
        const double cell_volume = std::pow(spacing, 3);
        std::array<int, 3> last{-1, -1, -1};
        for (const CutCell& cell : cut_cells(geometry, grid, 0.0)) {
          const auto& m = cell.moments;
          EXPECT_LE(m[0], 1.0);
          EXPECT_LT(std::tuple(last[2], last[1], last[0]),
                    std::tuple(cell.index[2], cell.index[1], cell.index[0]));
          last = cell.index;
          const Vector3 corner = grid.position(cell.index[0], cell.index[1], cell.index[2]);
          sum[0] += cell_volume * m[0];
          sum.tail<3>() +=
              cell_volume * (m[0] * corner + spacing * grid.axes * Vector3(m[1], m[2], m[4]));
        }
        const Eigen::Vector4d total = total_of(geometry.solid->mesh());
        EXPECT_NEAR(sum[0] / total[0], 1.0, 1e-9);
        EXPECT_NEAR(geometry.tip_volume() / total[0], 1.0, 1e-12);
        EXPECT_LT((sum.tail<3>() / sum[0] - total.tail<3>() / total[0]).norm(),
                  1e-9 * geometry.tip_radius);
      }
}

/// All eight moments of a cell, against the box's own; a grid turned by right angles agrees.
TEST(SolidCells, KnowAllMomentsOfABox) {
  const Geometry geometry =
      Geometry::of_solid(std::make_shared<Solid>(fingers::box(low, high), base));
  for (const bool turned : {false, true}) {
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
    if (turned) axes << 0, 0, 1, 1, 0, 0, 0, 1, 0;
    const double a = 1.3e-3;
    const CubicGrid grid = covering_grid(geometry, a, {0.1, 0.2, 0.3}, 1, axes);
    std::size_t whole = 0;
    for (const CutCell& cell : cut_cells(geometry, grid, 0.0)) {
      const Vector3 corner(cell.index[0], cell.index[1], cell.index[2]);
      const Vector3 one = grid.coordinates(low) - corner, other = grid.coordinates(high) - corner;
      const Vector3 from = one.cwiseMin(other).cwiseMax(0.0),
                    to = one.cwiseMax(other).cwiseMin(1.0);
      whole += cell.moments[0] == 1.0;
      for (std::size_t m = 0; m < 8; ++m) {
        double expected = 1.0;
        for (std::size_t d = 0; d < 3; ++d) {
          const double p = double(m >> d & 1) + 1.0;
          const auto e = Eigen::Index(d);
          expected *= (std::pow(to[e], p) - std::pow(from[e], p)) / p;
        }
        EXPECT_NEAR(cell.moments[m], expected, 1e-13);
      }
    }
    EXPECT_GT(whole, 500u);
  }
}

TEST(SolidCells, SampleTheParticlesOfTheDome) {
  const Geometry dome, geometry = fingers::solid_dome(48, 36);
  const double spacing = 0.0077 / 8;  // no point on a surface
  const auto expected = sample_particles(dome, covering_grid(dome, spacing, {0.21, 0.13, 0.37}, 1));
  const auto found =
      sample_particles(geometry, covering_grid(geometry, spacing, {0.21, 0.13, 0.37}, 1));
  const auto count = [](const auto& all) { return double(std::ranges::count(all, 1)); };
  EXPECT_NEAR(count(found) / count(expected), 1.0, 0.02);
}

TEST(SolidPoints, AddUpToAreaMomentAndNormal) {
  const Geometry block = Geometry::of_solid(std::make_shared<Solid>(fingers::box(low, high), base));
  for (const Geometry& body : {block, fingers::solid_dome()})
    for (const auto surface : {ProfileSurface::contact, ProfileSurface::bond}) {
      const bool flat = body.solid == block.solid;
      const double spacing = body.tip_radius / 20;
      double area = 0.0;
      Vector3 vector = Vector3::Zero(), own = Vector3::Zero(), moment = own, own_moment = own;
      const auto points = surface_points(body, surface, spacing);
      for (const SurfacePoint& point : points) {
        EXPECT_LE(point.area, 2.0 * spacing * spacing);
        EXPECT_NEAR(point.normal.norm(), 1.0, 1e-12);
        EXPECT_NEAR(body.solid->signed_distance(point.position), 0.0, flat ? 1e-9 : 0.05 * spacing);
        area += point.area;
        moment += point.area * point.position;
        vector += point.area * point.normal;
      }
      // About as many as of the dome, however many facets there are.
      EXPECT_LT(double(points.size()), 8.0 * area / (spacing * spacing) + 20.0);
      const Solid& solid = *body.solid;
      for (std::size_t t = 0; t < solid.mesh().triangles.size(); ++t)
        if (solid.is_bond(t) == (surface == ProfileSurface::bond)) {
          own += solid.mesh().area_vector(t);
          own_moment += solid.mesh().area_vector(t).norm() * solid.mesh().centroid(t);
        }
      EXPECT_NEAR(area / surface_area(body, surface), 1.0, 1e-12);
      EXPECT_LT((moment - own_moment).norm(), 1e-12 * area * body.tip_radius);
      EXPECT_LT((vector - own).norm(), (flat ? 1e-12 : 1e-3) * area);
    }
  EXPECT_TRUE(surface_points(block, ProfileSurface::free, 1e-3).empty());
}

TEST(SolidPoints, AreTheirOwnMirrorImages) {
  const Geometry block = Geometry::of_solid(
      std::make_shared<Solid>(fingers::box({-0.0061, -0.0053, 0.0}, {0.0061, 0.0053, 0.02}), base));
  for (const Geometry& body : {block, fingers::solid_dome(50, 32)}) {
    const auto points = surface_points(body, contact, 1.1e-3);
    for (const SurfacePoint& point : points)
      for (const int axis : {0, 1}) {
        Vector3 image = point.position;
        image[axis] = -image[axis];
        EXPECT_NE(image[axis], 0.0);
        const auto found = std::ranges::min_element(
            points, {}, [&](const SurfacePoint& other) { return (other.position - image).norm(); });
        EXPECT_LT((found->position - image).norm(), 1e-9);
        EXPECT_NEAR(found->area / point.area, 1.0, 1e-6);
      }
  }
}

TEST(Solid, FindsItsThinnestWall) {
  const auto hollow =
      joined(fingers::box(low, high),
             inside_out(fingers::box({-0.0045, -0.003, 0.004}, {0.002, 0.003, 0.015})));
  EXPECT_NEAR(Solid(hollow, base).wall(), 0.0015, 1e-12);
  // The rim of a cone is a wedge, which is no wall.
  const auto cone = fingers::revolved({{0.0, 0.0}, {0.01, 0.0}, {0.0, 0.02}}, 64);
  EXPECT_GT(Solid(cone, base).wall(), 0.009);
  // Nor does one begin at slivers beside a long edge, which the rim of the bond leaves.
  auto prism = fingers::revolved({{0.0, 0.0}, {1e-3, 0.0}, {1e-3, 1.0965e-3}, {0.0, 1.3965e-3}}, 4);
  for (Vector3& w : prism.vertices) w = Vector3(w.x() - 0.0806 * w.z(), 0.7188 * w.y(), w.z());
  EXPECT_GT(Solid(prism, {{{2, true, 1.0965e-5}}}).wall(), 1e-3);
}

TEST(Solid, KnowsThePlanesThatMirrorIt) {
  TriangleMesh box = fingers::box({-0.006, -0.005, 0.0}, {0.006, 0.005, 0.02});
  const Solid both(box, base);
  EXPECT_TRUE(both.mirrored(0));
  EXPECT_TRUE(both.mirrored(1));
  // Its facets, too, where they are held.
  const Solid one(box, {{{2, true, 0.001}, {0, false, 0.0}}});
  EXPECT_FALSE(one.mirrored(0));
  EXPECT_TRUE(one.mirrored(1));
  const Solid none(fingers::box(low, high), base);
  EXPECT_FALSE(none.mirrored(0));
  EXPECT_FALSE(none.mirrored(1));
  // A corner may be off by a ten thousandth of the largest radius.
  const auto moved = [&](double share) {
    TriangleMesh own = box;
    own.vertices.front().x() -= share * both.largest_radius();
    return Solid(own, base).mirrored(0);
  };
  EXPECT_TRUE(moved(0.9 * Solid::mirrored_within));
  EXPECT_FALSE(moved(3.0 * Solid::mirrored_within));
  // Facets of a round body need not lie as their images do, if they are as fine as of a CAD file.
  const Solid fine(fingers::revolved({{0.0, 0.0}, {0.01, 0.0}, {0.0, 0.02}}, 161), base);
  EXPECT_TRUE(fine.mirrored(0));
  // A polygon of 25 sides has one axis.
  const Solid odd(fingers::revolved({{0.0, 0.0}, {0.01, 0.0}, {0.0, 0.02}}, 25), base);
  EXPECT_FALSE(odd.mirrored(0));
  EXPECT_TRUE(odd.mirrored(1));
}

TEST(Solid, MergesCornersAndKnowsItsContent) {
  TriangleMesh loose;  // as an STL has it: every facet with corners of its own
  const TriangleMesh box = fingers::box(low, high);
  for (std::size_t t = 0; t < box.triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c)
      loose.vertices.push_back(box.corner(t, c) + 1e-9 * double(t) * Vector3::Ones());
    loose.triangles.push_back({int(3 * t), int(3 * t + 1), int(3 * t + 2)});
  }
  loose.triangles.push_back({0, 0, 1});  // without area
  const Solid solid(loose, base), same(loose, base), other(loose, {{{2, true, 0.001}}});
  EXPECT_EQ(solid.mesh().vertices.size(), 8u);
  EXPECT_EQ(solid.content(), same.content());
  EXPECT_NE(solid.content(), other.content());
}

TEST(Solid, RefusesWhatIsNoFinger) {
  const TriangleMesh box = fingers::box(low, high);
  TriangleMesh hole = box;
  hole.triangles.pop_back();
  expect_refused(hole, base, {"open edge at (x, y, z)", "closed", "fill the hole"});
  expect_refused(inside_out(box), base, {"all facets face inward", "turn the normals"});
  TriangleMesh turned = box;
  std::swap(turned.triangles[4][0], turned.triangles[4][1]);
  expect_refused(turned, base, {"edge at", "face the same way", "normals consistent"});
  expect_refused(joined(box, fingers::box({0.01, 0.0, 0.0}, {0.02, 0.01, 0.01})), base,
                 {"bodies near", "one body", "unite"});
  expect_refused(joined(box, inside_out(fingers::box({0.01, 0.0, 0.0}, {0.02, 0.01, 0.01}))), base,
                 {"face inward", "turn its normals"});
  expect_refused(joined(box, fingers::box({0.001, 0.001, 0.01}, {0.02, 0.002, 0.03})), base,
                 {"bodies near"});
  expect_refused(joined(box, inside_out(fingers::box({0.001, 0.001, 0.01}, {0.02, 0.002, 0.015}))),
                 base, {"facets near", "cross itself", "unite"});
  // Two boxes that share a corner alone.
  expect_refused(joined(box, fingers::box(high, high + Vector3::Constant(0.01))), base,
                 {"vertex at", "touch itself at a point"});
  // ... and an edge.
  expect_refused(joined(box, fingers::box({0.004, 0.007, 0.0}, {0.014, 0.017, 0.02})), base,
                 {"edge at", "two facets meet"});
  TriangleMesh metres = box, microns = box;
  for (Vector3& w : metres.vertices) w *= 1250.0;
  for (Vector3& w : microns.vertices) w *= 1e-3;
  expect_refused(metres, base, {"geometry.unit", "25 m across", "0.5 mm to 0.5 m"});
  expect_refused(microns, base, {"geometry.unit", "2e-05 m across"});
  expect_refused(box, {{{2, true, -0.001}}}, {"geometry.bond", "held by the hand"});
  expect_refused(box, {{{2, true, 0.1}}}, {"geometry.bond", "able to touch"});
  expect_refused(box, {{{2, false, 0.015}}}, {"geometry.bond", "geometry.up = \"-z\""});
  TriangleMesh aside = box;
  for (Vector3& w : aside.vertices) w.x() += 0.1;
  expect_refused(aside, base, {"axis x = y = 0", "geometry.origin = \"touch\""});
  // In the empty corner of an angle the axis is in the box around it, not in the finger.
  TriangleMesh angle;
  constexpr std::array<std::array<double, 2>, 6> corner{
      {{-10, -10}, {10, -10}, {10, -4}, {-4, -4}, {-4, 10}, {-10, 10}}};
  for (const double z : {0.0, 20.0})
    for (const auto& [x, y] : corner) angle.vertices.push_back(1e-3 * Vector3(x, y, z));
  for (int b = 1; b < 5; ++b) {
    angle.triangles.push_back({0, b + 1, b});
    angle.triangles.push_back({6, b + 6, b + 7});
  }
  for (int a = 0; a < 6; ++a) {
    const int b = (a + 1) % 6;
    angle.triangles.push_back({a, b, b + 6});
    angle.triangles.push_back({a, b + 6, a + 6});
  }
  expect_refused(angle, base, {"axis x = y = 0", "geometry.origin = \"touch\""});
  for (Vector3& w : angle.vertices) w.x() += 0.006;  // into an arm
  EXPECT_NO_THROW(Solid(angle, base));
  // In a tube it runs through the finger's middle.
  EXPECT_NO_THROW(Solid(
      fingers::revolved({{4e-3, 0.0}, {6e-3, 0.0}, {6e-3, 1e-2}, {4e-3, 1e-2}, {4e-3, 0.0}}, 24),
      base));
  expect_refused(TriangleMesh{}, base, {"0 facets", "at least four"});
  TriangleMesh broken = box;
  broken.vertices[3].x() = std::nan("");
  expect_refused(broken, base, {"finite numbers"});
}

}  // namespace
