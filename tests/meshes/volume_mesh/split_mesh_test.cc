// Hexahedra of a finger of any shape.
#include "meshes/volume_mesh/mesh_builders.h"
#include "meshes/volume_mesh/volume_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "meshes/shape/geometry.h"
#include "meshes/volume_mesh/boundary_parts.h"
#include "tests/fingers.h"
#include "tests/temporary_folder.h"

using namespace fingertip::meshes;

namespace {

struct Finger {
  const char* name;
  Geometry geometry;
  Sector sector;
  double share;  ///< of the whole in the sector
};

std::vector<Finger> finger_list() {
  const TriangleMesh box = fingers::box({-0.008, -0.01, 0.0}, {0.008, 0.01, 0.018});
  const auto block = std::make_shared<Solid>(box, Region{{{2, true, 1e-3}}}),
             glued = std::make_shared<Solid>(box, Region{{{2, true, 0.0}}});
  return {{"block", Geometry::of_solid(block), Sector::full, 1.0},
          {"dome of facets", fingers::solid_dome(48, 32), Sector::full, 1.0},
          {"half a block", Geometry::of_solid(glued), Sector::half, 0.5},
          {"quarter of a block", Geometry::of_solid(glued), Sector::quarter, 0.25},
          {"quarter of a dome of facets", fingers::solid_dome(48, 32), Sector::quarter, 0.25},
          {"quarter of one turned", fingers::solid_dome(50, 32), Sector::quarter, 0.25},
          {"dome", Geometry::of_profile(fingers::dome()), Sector::quarter, 0.25},
          {"half a dome", Geometry::of_profile(fingers::dome()), Sector::half, 0.5},
          {"finger", Geometry::of_profile(fingers::solid()), Sector::quarter, 0.25},
          {"hollow finger", Geometry::of_profile(fingers::hollow()), Sector::quarter, 0.25}};
}

MeshQuality write(const Finger& finger, double refinement, const std::filesystem::path& file) {
  TipMeshOptions options = TipMeshOptions{}.refined(refinement);
  options.sector = finger.sector;
  return write_tip_mesh(finger.geometry, options, file);
}

TEST(SplitMesh, FillsFingersOfEveryShape) {
  const TemporaryFolder folder;
  for (const Finger& finger : finger_list()) {
    SCOPED_TRACE(finger.name);
    const double volume = finger.share * shape_of(finger.geometry)->volume();
    double last = 0.04;
    for (const double refinement : {0.5, 1.4}) {
      const MeshQuality quality = write(finger, refinement, folder / "tip.msh");
      EXPECT_GT(quality.min_scaled_jacobian, 0.04);
      EXPECT_LT(quality.hexahedra, refinement < 1.0 ? 7000u : 40000u);
      // Straight sides between points of the surface.
      const double missing = std::abs(quality.volume / volume - 1.0);
      EXPECT_LT(missing, std::max(last, 1e-11));
      last = 0.6 * missing;
      EXPECT_EQ(inspect_tip_mesh(folder / "tip.msh").nodes, quality.nodes);
    }
    const std::string text = read_text(folder / "tip.msh");
    for (const std::string name : {"tip", "outer", "bond"})
      EXPECT_NE(text.find('"' + name + '"'), std::string::npos) << name;
    EXPECT_EQ(text.find("\"symmetry_y\"") != std::string::npos, finger.sector != Sector::full);
    EXPECT_EQ(text.find("\"symmetry_x\"") != std::string::npos, finger.sector == Sector::quarter);
  }
}

TEST(SplitMesh, IsTheSameForTheSameFinger) {
  const TemporaryFolder folder;
  const Finger finger = finger_list()[1];
  write(finger, 0.5, folder / "a.msh");
  write(finger, 0.4, folder / "other.msh");
  write(finger, 0.5, folder / "b.msh");
  EXPECT_EQ(read_text(folder / "a.msh"), read_text(folder / "b.msh"));
}

/// A bond as narrow as round-off asks for no elements of its width, also where mirror planes cut
/// its corners.
TEST(SplitMesh, IsCoarseAtHiddenEdges) {
  const TemporaryFolder folder;
  const TriangleMesh box = fingers::box({-0.008, -0.01, 0.0}, {0.008, 0.01, 0.018});
  const auto strip = std::make_shared<Solid>(box, Region{{{2, true, 1e-4}}}),
             flat = std::make_shared<Solid>(box, Region{{{2, true, 0.0}}});
  for (const Sector sector : {Sector::full, Sector::half, Sector::quarter}) {
    const auto count = [&](const std::shared_ptr<const Solid>& solid) {
      return write({"", Geometry::of_solid(solid), sector, 1.0}, 0.5, folder / "tip.msh").hexahedra;
    };
    EXPECT_LT(double(count(strip)), 1.5 * double(count(flat)));
  }
}

TEST(SplitMesh, IsFineWhereItIsTouchedFirst) {
  const TemporaryFolder folder;
  const Finger finger = finger_list()[0];
  TipMeshOptions options;
  options.cap_grading = 6.0;
  options.touch = Vector3(0.008, 0.01, 0.018);
  const auto count = write_tip_mesh(finger.geometry, options, folder / "tip.msh").hexahedra;
  options.cap_grading = 1.0;
  EXPECT_GT(count, write_tip_mesh(finger.geometry, options, folder / "tip.msh").hexahedra);
}

/// A block of 16 by 20 mm whose touching face has a step of 0.5 mm.
TEST(SplitMesh, FillsAFingerWithASmallStep) {
  constexpr double step = 5e-4, width = 0.01;
  // x and z, around.
  const std::vector<Eigen::Vector2d> outline = {{0.0, 0.018},           {0.0, 0.018 + step},
                                                {-0.008, 0.018 + step}, {-0.008, 0.0},
                                                {0.008, 0.0},           {0.008, 0.018}};
  TriangleMesh block;
  for (const double y : {-width, width})
    for (const auto& corner : outline) block.vertices.emplace_back(corner.x(), y, corner.y());
  const int count = int(outline.size());
  for (int i = 0; i < count; ++i) {
    const int next = (i + 1) % count;
    if (i > 0 && next > 0) {
      block.triangles.push_back({0, i, next});
      block.triangles.push_back({count, count + next, count + i});
    }
    block.triangles.push_back({i, count + next, next});
    block.triangles.push_back({i, count + i, count + next});
  }
  const Finger finger{"step",
                      Geometry::of_solid(std::make_shared<Solid>(block, Region{{{2, true, 1e-3}}})),
                      Sector::full, 1.0};
  const TemporaryFolder folder;
  const MeshQuality quality = write(finger, 0.5, folder / "tip.msh");
  EXPECT_GT(quality.min_scaled_jacobian, 0.04);
  EXPECT_LT(quality.hexahedra, 40000u);
  // The bond's edges alone are not followed.
  EXPECT_NEAR(quality.volume, shape_of(finger.geometry)->volume(), 0.02 * quality.volume);
}

/// What no number of tetrahedra fills is told, not tried for ever: edges a hair's breadth apart.
TEST(SplitMesh, RefusesEdgesVeryNearEachOther) {
  const TemporaryFolder folder;
  // A slit of 2 nm between two parts of the bond.
  TriangleMesh block = fingers::box({-0.008, -0.01, 0.0}, {0.008, 0.01, 0.018});
  const auto solid = std::make_shared<Solid>(
      block, Region{{{2, true, 0.0}, {0, true, 0.0}}, {{2, true, 0.0}, {0, false, 2e-7}}});
  try {
    write({"slit", Geometry::of_solid(solid), Sector::full, 1.0}, 0.5, folder / "tip.msh");
    ADD_FAILURE() << "not refused";
  } catch (const NotConverged& error) {
    EXPECT_NE(std::string(error.what()).find("very near each other"), std::string::npos);
  }
}

TEST(Tetrahedra, CloseTheBodyAndKeepItsEdges) {
  for (const Finger& finger : finger_list()) {
    SCOPED_TRACE(finger.name);
    const auto parts = boundary_parts(finger.geometry);
    const PartedSurface surface = parts->surface(finger.sector);
    closed_surface(surface.mesh);  // throws where it is open
    const Tetrahedra mesh = tetrahedra_within(
        surface, [](const Vector3&) { return 4e-3; }, 4e-4);
    double volume = 0.0;
    for (const auto& [a, b, c, d] : mesh.tetrahedra) {
      const auto at = [&](int v) { return mesh.vertices[std::size_t(v)]; };
      const double own = (at(b) - at(a)).cross(at(c) - at(a)).dot(at(d) - at(a)) / 6.0;
      EXPECT_GT(own, 0.0);
      volume += own;
    }
    EXPECT_NEAR(volume / (finger.share * shape_of(finger.geometry)->volume()), 1.0, 0.03);
    std::vector<double> areas(std::size_t(parts->count()), 0.0), wanted = areas;
    for (const auto& facet : mesh.facets) {
      const auto at = [&](std::size_t c) { return mesh.vertices[std::size_t(facet.corners[c])]; };
      ASSERT_GE(facet.part, 0);
      ASSERT_LT(facet.part, parts->count());
      areas[std::size_t(facet.part)] += 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_LT((parts->nearest(facet.part, at(c)) - at(c)).norm(), 1e-5);
    }
    for (std::size_t t = 0; t < surface.parts.size(); ++t)
      wanted[std::size_t(surface.parts[t])] += surface.mesh.area_vector(t).norm();
    // Edges within a solid's bond are no edges of the mesh.
    for (std::size_t p = 0; p < areas.size(); ++p) {
      const bool rounded = finger.geometry.solid && parts->tag(int(p)) == PhysicalTag::bond;
      EXPECT_NEAR(areas[p], wanted[p], (rounded ? 0.2 : 0.05) * wanted[p]) << "part " << p;
    }
  }
}

TEST(BoundaryParts, AreWhereTheyAreSaidToBe) {
  const Geometry g;
  const auto dome = boundary_parts(Geometry::of_profile(fingers::dome(g)));
  const Vector3 outside(0.008, 0.006, 0.004);
  const int cap = dome->part_at(PhysicalTag::outer, outside);
  EXPECT_EQ(dome->tag(cap), PhysicalTag::outer);
  EXPECT_NEAR(dome->nearest(cap, outside).norm(), g.tip_radius, 1e-12);
  EXPECT_LT(dome->nearest(cap, outside).cross(outside).norm(), 1e-14);
  // On the rim of the sleeve two parts meet, in the plane y = 0 a third.
  const int sleeve = dome->part_at(PhysicalTag::outer, {0.012, 0.0, -0.01}),
            end = dome->part_at(PhysicalTag::end, {0.008, 0.0, -0.015}),
            plane = dome->part_at(PhysicalTag::symmetry_y, {0.008, 1e-4, 0.0});
  const Vector3 rim = dome->on({sleeve, end}, {0.009, 0.003, -0.013});
  EXPECT_NEAR(rim.head<2>().norm(), g.tip_radius, 1e-12);
  EXPECT_NEAR(rim.z(), -g.sleeve_length, 1e-12);
  EXPECT_NEAR(rim.y() / rim.x(), 1.0 / 3.0, 1e-12);
  EXPECT_LT(
      (dome->on({sleeve, end, plane}, {0.009, 1e-4, -0.013}) - Vector3(0.01, 0.0, -0.015)).norm(),
      1e-12);

  // A block has six faces and two mirror planes; what the bond cuts off from four of them is too
  // narrow to be parts.
  const auto block = boundary_parts(finger_list()[0].geometry);
  EXPECT_EQ(block->count(), 8);
  EXPECT_EQ(block->part_at(PhysicalTag::end, {0.0, 0.0, 0.0}), -1);
  const int top = block->part_at(PhysicalTag::outer, {0.0, 0.0, 0.02}),
            side = block->part_at(PhysicalTag::outer, {0.02, 0.0, 0.01});
  EXPECT_LT((block->on({top, side}, {0.007, 0.002, 0.017}) - Vector3(0.008, 0.002, 0.018)).norm(),
            1e-12);
  // Facets of a dome are one part, and a sliver beside the bond belongs to its neighbour.
  EXPECT_EQ(boundary_parts(fingers::solid_dome(48, 32))->count(), 5);
  EXPECT_THROW(boundary_parts({0.01, 0.02, 0.015, 0.03}), InvalidInput);
}

TEST(BoundaryParts, OfAChamferAreThree) {
  const auto finger = std::make_shared<Solid>(
      fingers::revolved({{0.0, 0.0}, {0.008, 0.0}, {0.008, 0.017}, {0.007, 0.018}, {0.0, 0.018}},
                        48),
      Region{{{2, true, 1e-3}}});
  const auto parts = boundary_parts(Geometry::of_solid(finger));
  EXPECT_EQ(parts->count(), 6);  // with what is held and two planes
  const int chamfer = parts->part_at(PhysicalTag::outer, {0.0075, 0.0, 0.0175}),
            top = parts->part_at(PhysicalTag::outer, {0.0, 0.0, 0.02}),
            side = parts->part_at(PhysicalTag::outer, {0.01, 0.0, 0.01});
  EXPECT_NE(chamfer, top);
  EXPECT_NE(chamfer, side);
  EXPECT_NE(top, side);
}

/// A lip of 10 degrees, where the way to the edge is long.
TEST(BoundaryParts, OfAThinLipMeetAtItsEdge) {
  TriangleMesh lip = fingers::box({-0.01, -0.01, 0.0}, {0.01, 0.01, 0.002});
  for (Vector3& w : lip.vertices)
    if (w.x() > 0.0 && w.z() == 0.0) w.x() -= 0.002 / std::tan(std::numbers::pi / 18.0);
  const auto parts =
      boundary_parts(Geometry::of_solid(std::make_shared<Solid>(lip, Region{{{2, true, 1e-4}}})));
  const int top = parts->part_at(PhysicalTag::outer, {0.0, 0.0, 0.003}),
            below = parts->part_at(PhysicalTag::outer, {0.005, 0.0, 0.0});
  ASSERT_NE(top, below);
  EXPECT_LT((parts->on({top, below}, {0.0095, 0.001, 0.0019}) - Vector3(0.01, 0.001, 0.002)).norm(),
            1e-11);
}

}  // namespace
