#include "lattice/model/embedded_points.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::lattice::inline model {

using meshes::Vector3;

namespace {

/// Distance of a point from a cell, both in grid coordinates; 0 inside.
double distance(const Vector3& at, const Vector3& lowest) {
  const Vector3 local = at - lowest;
  return (local - local.cwiseMax(0.0).cwiseMin(1.0)).norm();
}

/// The cell that holds the point at grid coordinates `at`, or the nearest of those around it.
std::uint32_t nearest_cell(const GridCells& cells, const Vector3& at) {
  const int i = int(std::floor(at.x())), j = int(std::floor(at.y())), k = int(std::floor(at.z()));
  std::uint32_t nearest = cells.cell_at(i, j, k);
  if (nearest != GridCells::none) return nearest;
  double least = std::numeric_limits<double>::infinity();
  for (int dk = -1; dk <= 1; ++dk) {
    for (int dj = -1; dj <= 1; ++dj) {
      for (int di = -1; di <= 1; ++di) {
        const std::uint32_t cell = cells.cell_at(i + di, j + dj, k + dk);
        if (cell == GridCells::none) continue;
        const double away = distance(at, Vector3(i + di, j + dj, k + dk));
        if (away >= least) continue;
        least = away;
        nearest = cell;
      }
    }
  }
  return nearest;
}

}  // namespace

EmbeddedPoint tie(const GridCells& cells, const meshes::SurfacePoint& point, double stiffness) {
  const Vector3 at = cells.grid().coordinates(point.position);
  const std::uint32_t nearest = nearest_cell(cells, at);
  if (nearest == GridCells::none) {
    throw meshes::InvalidInput({"lattice.spacing", meshes::to_text(cells.grid().spacing) + " m",
                                "every point of the tip's surface needs a cell near it",
                                "choose a finer lattice"});
  }
  const meshes::CutCell& cell = cells.cells()[nearest];
  const Vector3 local = at - Vector3(cell.index[0], cell.index[1], cell.index[2]);
  EmbeddedPoint embedded;
  embedded.corners = cells.corners(cell);
  for (int c = 0; c < 8; ++c) {
    double& weight = embedded.weights[std::size_t(c)];
    weight = 1.0;
    for (int d = 0; d < 3; ++d) weight *= (c >> d & 1) != 0 ? local[d] : 1.0 - local[d];
  }
  embedded.rest = point.position;
  embedded.normal = point.normal;
  embedded.area = point.area;
  embedded.stiffness = stiffness * point.area;
  return embedded;
}

EmbeddedPoint tie_to_particle(std::uint32_t particle, const Vector3& rest, const Vector3& normal,
                              double area, double stiffness) {
  EmbeddedPoint embedded;
  embedded.corners.fill(particle);
  embedded.weights[0] = 1.0;
  embedded.rest = rest;
  embedded.normal = normal;
  embedded.area = area;
  embedded.stiffness = stiffness;
  return embedded;
}

Vector3 carried_surface(const EmbeddedPoint& point,
                        const Eigen::Matrix<double, 3, 8>& displacements,
                        const Eigen::Matrix3d& edges) {
  Vector3 local = Vector3::Zero();
  for (int c = 0; c < 8; ++c)
    for (int d = 0; d < 3; ++d)
      if ((c >> d & 1) != 0) local[d] += point.weights[std::size_t(c)];
  // A point beyond its cell goes on as the cell does at its side.
  local = local.cwiseMax(0.0).cwiseMin(1.0);
  Eigen::Matrix3d now = edges;  // of the edges
  for (int c = 0; c < 8; ++c) {
    for (int d = 0; d < 3; ++d) {
      double slope = (c >> d & 1) != 0 ? 1.0 : -1.0;
      for (int e = 0; e < 3; ++e)
        if (e != d) slope *= (c >> e & 1) != 0 ? local[e] : 1.0 - local[e];
      now.col(d) += slope * displacements.col(c);
    }
  }
  // J F^-T with F = now edges^-1.
  const Eigen::Matrix3d gradient = now * edges.inverse();
  return point.area * gradient.determinant() * gradient.inverse().transpose() * point.normal;
}

}  // namespace fingertip::lattice::inline model
