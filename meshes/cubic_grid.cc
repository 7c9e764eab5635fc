#include "meshes/cubic_grid.h"

#include <Eigen/LU>
#include <cmath>

#include "meshes/files.h"

namespace fingertip::meshes {

namespace {

void check(const Geometry& geometry, double spacing, const Vector3& offset,
           const Eigen::Matrix3d& axes) {
  std::vector<Violation> found;
  if (!(std::isfinite(spacing) && spacing > 0.0 && spacing <= 0.5 * geometry.thickness())) {
    found.push_back({"lattice.spacing", to_text(spacing) + " m",
                     "the spacing must be positive and at most (R - r)/2, two cells through the "
                     "rubber",
                     "choose a finer lattice"});
  }
  if (!(offset.allFinite() && offset.cwiseAbs().maxCoeff() <= 1.0)) {
    found.push_back({"lattice.offset", "",
                     "every component of the offset must lie between -1 and 1 spacing",
                     "shift the grid by less"});
  }
  const Eigen::Matrix3d defect = axes.transpose() * axes - Eigen::Matrix3d::Identity();
  if (!(axes.allFinite() && defect.cwiseAbs().maxCoeff() < 1e-9 && axes.determinant() > 0.0)) {
    found.push_back({"lattice.rotation", "",
                     "the grid's directions must be orthonormal and right-handed",
                     "give a rotation matrix"});
  }
  if (!found.empty()) throw InvalidInput(found);
}

/// How far the tip reaches from the centre (0, 0, -L) of its end along the unit vector d [m].
double reach(const Geometry& geometry, const Vector3& d) {
  // The farthest point is on the hemisphere if d points upward, else on the rim of the end.
  return d.z() >= 0.0 ? geometry.tip_radius + geometry.sleeve_length * d.z()
                      : geometry.tip_radius * std::hypot(d.x(), d.y());
}

}  // namespace

CubicGrid covering_grid(const Geometry& geometry, double spacing, const Vector3& offset, int margin,
                        const Eigen::Matrix3d& axes) {
  check(geometry, spacing, offset, axes);
  CubicGrid grid;
  grid.spacing = spacing;
  grid.axes = axes;
  Vector3 below;  // points on the lower side of the end's centre
  for (int d = 0; d < 3; ++d) {
    // One layer more than the extent asks for, since the offset may shift points outward.
    const auto layers = [&](const Vector3& direction) {
      return int(std::ceil(reach(geometry, direction) / spacing)) + 1 + margin;
    };
    const int lower = layers(-axes.col(d));
    below[d] = lower;
    grid.size[std::size_t(d)] = lower + layers(axes.col(d)) + 1;
  }
  const Vector3 end_centre(0.0, 0.0, -geometry.sleeve_length);
  grid.origin = spacing * (offset - below) + axes.transpose() * end_centre;
  return grid;
}

std::vector<std::uint8_t> sample_particles(const Geometry& geometry, const CubicGrid& grid) {
  const double tolerance = 1e-9 * geometry.tip_radius;
  std::vector<std::uint8_t> inside(grid.points(), 0);
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        inside[grid.index(i, j, k)] = geometry.contains(grid.position(i, j, k), tolerance);
      }
    }
  }
  return inside;
}

double expected_particle_count(const Geometry& geometry, double spacing) {
  return geometry.tip_volume() / (spacing * spacing * spacing);
}

}  // namespace fingertip::meshes
