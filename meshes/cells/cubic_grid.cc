#include "meshes/cells/cubic_grid.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "meshes/base/files.h"
#include "meshes/shape/geometry.h"

namespace fingertip::meshes::inline cells {

namespace {

void check(const Geometry& geometry, double spacing, const Vector3& offset,
           const Eigen::Matrix3d& axes) {
  std::vector<Violation> found;
  if (!(std::isfinite(spacing) && spacing > 0.0 && spacing <= geometry.coarsest_spacing())) {
    found.push_back(too_coarse(geometry, spacing));
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
  const double across = geometry.tip_radius * std::hypot(d.x(), d.y());
  if (!geometry.is_dome())
    return across + (geometry.pole() - geometry.lowest()) * std::max(0.0, d.z());
  // The farthest point is on the hemisphere if d points upward, else on the rim of the end.
  return d.z() >= 0.0 ? geometry.tip_radius + geometry.sleeve_length * d.z() : across;
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
  const Vector3 end_centre(0.0, 0.0, geometry.lowest());
  grid.origin = spacing * (offset - below) + axes.transpose() * end_centre;
  return grid;
}

std::vector<std::uint8_t> sample_particles(const Geometry& geometry, const CubicGrid& grid) {
  const double tolerance = 1e-9 * geometry.tip_radius;
  const auto shape = geometry.is_dome() ? nullptr : shape_of(geometry);
  const auto contains = [&](const Vector3& w) {
    if (!shape) return geometry.contains(w, tolerance);
    // As of the dome: what lies on the surface belongs to it, but not on the bond.
    const double distance = shape->signed_distance(w);
    return distance <= -tolerance ||
           (distance <= tolerance && shape->nearest(ProfileSurface::bond, w).distance > tolerance);
  };
  std::vector<std::uint8_t> inside(grid.points(), 0);
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        inside[grid.index(i, j, k)] = contains(grid.position(i, j, k));
      }
    }
  }
  return inside;
}

double expected_particle_count(const Geometry& geometry, double spacing) {
  return geometry.tip_volume() / (spacing * spacing * spacing);
}

}  // namespace fingertip::meshes::inline cells
