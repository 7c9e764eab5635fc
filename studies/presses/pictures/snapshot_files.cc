#include "studies/presses/pictures/snapshot_files.h"

#include <string>

#include "meshes/tables/table_rows.h"
#include "studies/files/run_tables.h"

namespace fingertip::studies::inline presses::inline pictures {

namespace fs = std::filesystem;
using lattice::MomentPicture;
using meshes::Vector3;

namespace {

/// Rounded to 10 nm, far below what a picture shows.
Vector3 rounded(const Vector3& point) {
  return (1e8 * point).array().round().matrix() / 1e8;
}

void write_boundary(const lattice::PressShapes& shapes, const fs::path& folder) {
  std::vector<BoundaryRow> rows;
  const MomentPicture& end = shapes.snapshots.back();
  for (std::size_t i = 0; i < shapes.boundary_rest.size(); ++i)
    rows.push_back({shapes.boundary_rest[i], end.boundary[i], end.held[i] != 0});
  meshes::write_rows(rows, folder / "boundary.csv");
  std::vector<BoundarySpringRow> springs;
  for (const auto& [i, j] : shapes.boundary_springs)
    springs.push_back({std::size_t(i), std::size_t(j)});
  meshes::write_rows(springs, folder / "boundary_springs.csv");
}

void write_snapshots(const std::vector<MomentPicture>& snapshots, const fs::path& folder) {
  std::vector<SnapshotRow> rows;
  std::vector<SnapshotPointRow> points;
  for (std::size_t s = 0; s < snapshots.size(); ++s) {
    const MomentPicture& picture = snapshots[s];
    rows.push_back({std::string(name(picture.moment)), picture.time, picture.indentation,
                    picture.endpoint, lattice::rotation_vector(picture.rod.orientation),
                    picture.on_rod.force, picture.on_rod.torque, picture.plane.point,
                    picture.plane.normal});
    for (std::size_t p = 0; p < picture.boundary.size(); ++p)
      points.push_back({s, rounded(picture.boundary[p]), picture.held[p] != 0});
  }
  meshes::write_rows(rows, folder / "snapshots.csv");
  meshes::write_rows(points, folder / "snapshot_points.csv");
}

}  // namespace

void write_shapes(const lattice::PressShapes& shapes, const fs::path& folder) {
  write_boundary(shapes, folder);
  write_snapshots(shapes.snapshots, folder);
}

}  // namespace fingertip::studies::inline presses::inline pictures
