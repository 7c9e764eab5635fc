#include "studies/run/snapshot_files.h"

#include <array>
#include <cmath>

#include "meshes/table_rows.h"
#include "studies/files/run_tables.h"

namespace fingertip::studies {

namespace fs = std::filesystem;
using lattice::FingerPicture;
using meshes::Vector3;

namespace {

/// Rounded to 10 nm, far below what a picture shows.
Vector3 rounded(const Vector3& point) {
  return (1e8 * point).array().round().matrix() / 1e8;
}

/// The last snapshot is taken at the end, whatever was reached before.
const char* moment(std::size_t place, std::size_t count) {
  constexpr std::array names = {"before contact", "first touch", "half depth"};
  return place + 1 < count ? names.at(place) : "end";
}

}  // namespace

void write_boundary(const lattice::PressOutcome& outcome, const fs::path& folder) {
  std::vector<BoundaryRow> rows;
  for (std::size_t i = 0; i < outcome.boundary_rest.size(); ++i)
    rows.push_back({outcome.boundary_rest[i], outcome.boundary_deformed[i],
                    outcome.boundary_anchored[i] != 0});
  meshes::write_rows(rows, folder / "boundary.csv");
  std::vector<BoundarySpringRow> springs;
  for (const auto& [i, j] : outcome.boundary_springs)
    springs.push_back({std::size_t(i), std::size_t(j)});
  meshes::write_rows(springs, folder / "boundary_springs.csv");
}

void write_snapshots(const lattice::PressOutcome& outcome, const fs::path& folder) {
  const std::vector<FingerPicture>& snapshots = outcome.snapshots;
  std::vector<SnapshotRow> rows;
  std::vector<SnapshotPointRow> points;
  for (std::size_t s = 0; s < snapshots.size(); ++s) {
    const FingerPicture& picture = snapshots[s];
    rows.push_back({moment(s, snapshots.size()), picture.time, picture.indentation,
                    picture.endpoint, lattice::rotation_vector(picture.rod.orientation),
                    picture.on_rod.force, picture.on_rod.torque, picture.plane.point,
                    picture.plane.normal});
    for (std::size_t p = 0; p < picture.boundary.size(); ++p)
      points.push_back({s, rounded(picture.boundary[p]), picture.held[p] != 0});
  }
  meshes::write_rows(rows, folder / "snapshots.csv");
  meshes::write_rows(points, folder / "snapshot_points.csv");
}

}  // namespace fingertip::studies
