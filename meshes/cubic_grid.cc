#include "meshes/cubic_grid.h"

#include <cmath>

#include "meshes/files.h"

namespace fingertip::meshes {

namespace {

void check(const Geometry& geometry, double spacing, const Vector3& offset) {
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
  if (!found.empty()) throw InvalidInput(found);
}

}  // namespace

CubicGrid covering_grid(const Geometry& geometry, double spacing, const Vector3& offset,
                        int margin) {
  check(geometry, spacing, offset);
  // One layer more than the extent asks for, since the offset may shift points outward.
  const int across = int(std::ceil(geometry.tip_radius / spacing)) + 1 + margin;
  const int along = int(std::ceil((geometry.sleeve_length + geometry.tip_radius) / spacing)) + 1;
  CubicGrid grid;
  grid.spacing = spacing;
  grid.size = {2 * across + 1, 2 * across + 1, along + 2 * margin + 2};
  grid.origin = spacing * (offset - Vector3(across, across, margin + 1));
  grid.origin.z() -= geometry.sleeve_length;
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
