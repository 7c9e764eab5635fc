#include "studies/run/snapshot_files.h"

#include <array>
#include <cmath>
#include <ostream>

#include "meshes/files.h"

namespace fingertip::studies {

namespace fs = std::filesystem;
using lattice::FingerPicture;
using meshes::Vector3;

namespace {

void put(std::ostream& out, const Vector3& point) {
  for (int axis = 0; axis < 3; ++axis) out << ',' << meshes::to_text(point[axis]);
}

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
  meshes::write_atomically(folder / "boundary.csv", [&](std::ostream& out) {
    out << "x [m],y [m],z [m],deformed_x [m],deformed_y [m],deformed_z [m],anchored\n";
    for (std::size_t i = 0; i < outcome.boundary_rest.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis)
        out << meshes::to_text(outcome.boundary_rest[i][axis]) << (axis < 2 ? "," : "");
      put(out, outcome.boundary_deformed[i]);
      out << ',' << int(outcome.boundary_anchored[i]) << '\n';
    }
  });
  meshes::write_atomically(folder / "boundary_springs.csv", [&](std::ostream& out) {
    out << "i,j\n";
    for (const auto& [i, j] : outcome.boundary_springs) out << i << ',' << j << '\n';
  });
}

void write_snapshots(const lattice::PressOutcome& outcome, const fs::path& folder) {
  const std::vector<FingerPicture>& snapshots = outcome.snapshots;
  meshes::write_atomically(folder / "snapshots.csv", [&](std::ostream& out) {
    out << "moment,time [s],indentation [m],endpoint_x [m],endpoint_y [m],endpoint_z [m],"
           "turn_x [rad],turn_y [rad],turn_z [rad],force_x [N],force_y [N],force_z [N],"
           "torque_x [N m],torque_y [N m],torque_z [N m],plane_x [m],plane_y [m],plane_z [m],"
           "normal_x,normal_y,normal_z\n";
    for (std::size_t s = 0; s < snapshots.size(); ++s) {
      const FingerPicture& one = snapshots[s];
      out << moment(s, snapshots.size()) << ',' << meshes::to_text(one.time) << ','
          << meshes::to_text(one.indentation);
      for (const Vector3& value :
           {one.endpoint, lattice::rotation_vector(one.rod.orientation), one.on_rod.force,
            one.on_rod.torque, one.plane.point, one.plane.normal})
        put(out, value);
      out << '\n';
    }
  });
  meshes::write_atomically(folder / "snapshot_points.csv", [&](std::ostream& out) {
    out << "snapshot,x [m],y [m],z [m],held\n";
    for (std::size_t s = 0; s < snapshots.size(); ++s) {
      for (std::size_t p = 0; p < snapshots[s].boundary.size(); ++p) {
        out << s;
        put(out, rounded(snapshots[s].boundary[p]));
        out << ',' << int(snapshots[s].held[p]) << '\n';
      }
    }
  });
}

}  // namespace fingertip::studies
