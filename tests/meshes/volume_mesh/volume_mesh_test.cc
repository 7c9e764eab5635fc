#include "meshes/volume_mesh/volume_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/expectations.h"
#include "tests/temporary_folder.h"

using namespace fingertip::meshes;

namespace {

class VolumeMesh : public ::testing::Test {
 protected:
  std::string text() const { return read_text(file_); }

  /// The coordinates in the $Nodes section of an MSH 4.1 file.
  std::vector<Vector3> nodes() const {
    std::ifstream in(file_);
    std::string line;
    while (std::getline(in, line) && line != "$Nodes") {
    }
    std::size_t blocks = 0, total = 0, skip = 0;
    in >> blocks >> total >> skip >> skip;
    std::vector<Vector3> result;
    for (std::size_t block = 0; block < blocks; ++block) {
      std::size_t dimension = 0, entity = 0, parametric = 0, count = 0, tag = 0;
      in >> dimension >> entity >> parametric >> count;
      for (std::size_t i = 0; i < count; ++i) in >> tag;
      for (std::size_t i = 0; i < count; ++i) {
        Vector3 w;
        in >> w.x() >> w.y() >> w.z();
        result.push_back(w);
      }
    }
    EXPECT_EQ(result.size(), total);
    return result;
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "tip.msh";
};

/// Nodes on one spherical or cylindrical layer of the block structure.
std::size_t nodes_per_layer(const TipMeshOptions& o, bool sleeve) {
  const std::size_t n = std::size_t(o.cap_elements);
  const std::size_t rows = std::size_t(o.ring_elements + (sleeve ? o.sleeve_elements : 0));
  if (o.sector == Sector::quarter) return (n + 1) * (n + 1) + (2 * n + 1) * rows;
  if (o.sector == Sector::half) return (n + 1) * (2 * n + 1) + (4 * n + 1) * rows;
  return 4 * n * n + 4 * n + 1 + 8 * n * rows;
}

TEST_F(VolumeMesh, HasTheNodesOfItsBlocksAndSharesThem) {
  for (const Sector sector : {Sector::quarter, Sector::half, Sector::full})
    for (const double length : {0.015, 0.0}) {
      Geometry geometry;
      geometry.sleeve_length = length;
      TipMeshOptions options;
      options.sector = sector;
      options = options.refined(0.5);
      const MeshQuality quality = write_tip_mesh(geometry, options, file_);
      const std::size_t layers = std::size_t(options.radial_elements) + 1;
      const std::size_t per_layer = nodes_per_layer(options, length > 0);
      EXPECT_EQ(quality.nodes, layers * per_layer);
      std::size_t outer = 0, bond = 0;
      const auto all = nodes();
      EXPECT_EQ(all.size(), quality.nodes);
      for (const Vector3& w : all) {
        EXPECT_LE(geometry.signed_distance(w), 1e-14);
        outer += std::abs(Geometry::radial_distance(w) - geometry.tip_radius) < 1e-15;
        bond += std::abs(Geometry::radial_distance(w) - geometry.rod_radius) < 1e-15;
        if (sector == Sector::quarter) {
          EXPECT_GE(w.x(), -1e-17);
        }
        if (sector != Sector::full) {
          EXPECT_GE(w.y(), -1e-17);
        }
      }
      EXPECT_EQ(outer, per_layer);
      EXPECT_EQ(bond, per_layer);
    }
}

TEST_F(VolumeMesh, IsOfGoodQualityAndFillsTheTip) {
  const Geometry geometry;
  double previous = 1.0;
  for (const double refinement : {0.5, 1.0, 2.0}) {
    const MeshQuality quality =
        write_tip_mesh(geometry, TipMeshOptions{}.refined(refinement), file_);
    EXPECT_GT(quality.min_jacobian, 0.0);
    EXPECT_GT(quality.min_scaled_jacobian, 0.8);
    // Straight sides cut the corners off: a deficit that falls like h².
    const double missing = 1.0 - quality.volume / (geometry.tip_volume() / 4);
    EXPECT_GT(missing, 0.0);
    EXPECT_LT(missing, previous / 3);
    previous = missing;
  }
  EXPECT_LT(previous, 1e-3);
}

TEST_F(VolumeMesh, FullTipIsFourQuarters) {
  TipMeshOptions options = TipMeshOptions{}.refined(0.5);
  const MeshQuality quarter = write_tip_mesh({}, options, file_);
  EXPECT_NE(text().find("\"symmetry_x\""), std::string::npos);
  options.sector = Sector::full;
  const MeshQuality full = write_tip_mesh({}, options, file_);
  EXPECT_EQ(text().find("symmetry"), std::string::npos);
  EXPECT_EQ(full.hexahedra, 4 * quarter.hexahedra);
  // gmsh finds its nodes on graded arcs by numerical integration, good to 2e-9 R here.
  EXPECT_NEAR(full.volume / (4 * quarter.volume), 1.0, 1e-9);
  EXPECT_NEAR(full.min_scaled_jacobian, quarter.min_scaled_jacobian, 1e-9);
}

/// Largest distance of a node's mirror image from the nearest node [m].
template <class Mirror>
double asymmetry(const std::vector<Vector3>& nodes, Mirror mirror) {
  double farthest = 0.0;
  for (const Vector3& w : nodes) {
    double nearest = 1.0;
    for (const Vector3& other : nodes) nearest = std::min(nearest, (other - mirror(w)).norm());
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

/// The tip is symmetric about x = y, and so must be its mesh.
TEST_F(VolumeMesh, IsItsOwnMirrorImage) {
  write_tip_mesh({}, TipMeshOptions{}.refined(0.5), file_);
  EXPECT_LT(asymmetry(nodes(), [](const Vector3& w) { return Vector3(w.y(), w.x(), w.z()); }),
            1e-9);
}

TEST_F(VolumeMesh, HalfTipIsTwoQuartersAndSymmetricAboutX) {
  TipMeshOptions options = TipMeshOptions{}.refined(0.5);
  const MeshQuality quarter = write_tip_mesh({}, options, file_);
  options.sector = Sector::half;
  const MeshQuality half = write_tip_mesh({}, options, file_);
  EXPECT_EQ(half.hexahedra, 2 * quarter.hexahedra);
  EXPECT_NEAR(half.volume / (2 * quarter.volume), 1.0, 1e-9);
  EXPECT_NEAR(half.min_scaled_jacobian, quarter.min_scaled_jacobian, 1e-9);
  const auto all = nodes();
  EXPECT_LT(asymmetry(all, [](const Vector3& w) { return Vector3(-w.x(), w.y(), w.z()); }), 1e-9);
  EXPECT_TRUE(std::ranges::any_of(all, [](const Vector3& w) { return w.x() < -1e-3; }));
}

/// The half keeps y = 0 as a boundary, on both sides of the axis, and loses x = 0.
TEST_F(VolumeMesh, HalfTipNamesOneSymmetryPlane) {
  TipMeshOptions options = TipMeshOptions{}.refined(0.5);
  options.sector = Sector::half;
  write_tip_mesh({}, options, file_);
  const std::string mesh = text();
  for (const char* group :
       {"3 1 \"tip\"", "2 2 \"outer\"", "2 3 \"bond\"", "2 4 \"end\"", "2 6 \"symmetry_y\""})
    EXPECT_NE(mesh.find(group), std::string::npos) << group;
  EXPECT_EQ(mesh.find("symmetry_x"), std::string::npos);
}

TEST_F(VolumeMesh, NamesItsGroups) {
  write_tip_mesh({}, TipMeshOptions{}.refined(0.5), file_);
  const std::string mesh = text();
  for (const char* group : {"3 1 \"tip\"", "2 2 \"outer\"", "2 3 \"bond\"", "2 4 \"end\"",
                            "2 5 \"symmetry_x\"", "2 6 \"symmetry_y\""})
    EXPECT_NE(mesh.find(group), std::string::npos) << group;
}

TEST_F(VolumeMesh, IsFineAtThePoleAndAtBothSurfaces) {
  const TipMeshOptions options;
  write_tip_mesh({}, options, file_);
  const double R = Geometry{}.tip_radius, r = Geometry{}.rod_radius;
  double next_to_pole = 1.0;
  std::vector<double> axis;  // where z runs through the rubber
  for (const Vector3& w : nodes()) {
    const double lateral = std::hypot(w.x(), w.y());
    if (std::abs(w.norm() - R) < 1e-12 && lateral > 1e-9)
      next_to_pole = std::min(next_to_pole, lateral);
    if (lateral < 1e-9) axis.push_back(w.z());
  }
  EXPECT_LT(next_to_pole, 0.75 * R * options.cap_angle / options.cap_elements);

  std::ranges::sort(axis);
  const std::size_t layers = std::size_t(options.radial_elements);
  ASSERT_EQ(axis.size(), layers + 1);
  const auto thickness = [&](std::size_t layer) { return axis[layer + 1] - axis[layer]; };
  EXPECT_NEAR(axis.back() - axis.front(), R - r, 1e-15);
  EXPECT_NEAR(thickness(0), thickness(layers - 1), 1e-9);
  EXPECT_GT(thickness(layers / 2) / thickness(0), 1.5);
  EXPECT_LT(thickness(layers / 2) / thickness(0), options.radial_grading);
}

TEST_F(VolumeMesh, RefusesBrokenOptions) {
  const auto refuses = [&](auto&& spoil) {
    TipMeshOptions options;
    spoil(options);
    EXPECT_THROW(write_tip_mesh({}, options, file_), InvalidInput);
    EXPECT_FALSE(std::filesystem::exists(file_));
  };
  refuses([](TipMeshOptions& o) { o.cap_elements = 1; });
  refuses([](TipMeshOptions& o) { o.radial_elements = 0; });
  refuses([](TipMeshOptions& o) { o.cap_grading = 0.5; });
  refuses([](TipMeshOptions& o) { o.radial_grading = std::nan(""); });
  refuses([](TipMeshOptions& o) { o.cap_angle = 1.5; });
  Geometry solid;
  solid.rod_radius = 0.02;
  EXPECT_THROW(write_tip_mesh(solid, {}, file_), InvalidInput);
}

}  // namespace
