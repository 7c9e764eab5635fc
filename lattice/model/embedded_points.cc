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

}  // namespace

std::optional<PlaceInCell> place_in_cell(
    const Vector3& at, const std::function<bool(const std::array<int, 3>&)>& is_there) {
  const std::array<int, 3> own{int(std::floor(at.x())), int(std::floor(at.y())),
                               int(std::floor(at.z()))};
  std::optional<PlaceInCell> nearest;
  double least = std::numeric_limits<double>::infinity();
  const auto look_at = [&](const std::array<int, 3>& lowest) {
    const double away = distance(at, Vector3(lowest[0], lowest[1], lowest[2]));
    if (away >= least || !is_there(lowest)) return;
    least = away;
    nearest = PlaceInCell{lowest};
  };
  look_at(own);
  for (int dk = -1; dk <= 1; ++dk)
    for (int dj = -1; dj <= 1; ++dj)
      for (int di = -1; di <= 1; ++di) look_at({own[0] + di, own[1] + dj, own[2] + dk});
  if (!nearest) return nearest;
  const Vector3 local = at - Vector3(nearest->lowest[0], nearest->lowest[1], nearest->lowest[2]);
  for (int c = 0; c < 8; ++c) {
    double& weight = nearest->weights[std::size_t(c)];
    weight = 1.0;
    for (int d = 0; d < 3; ++d) weight *= (c >> d & 1) != 0 ? local[d] : 1.0 - local[d];
  }
  return nearest;
}

EmbeddedPoint tie(const GridCells& cells, const meshes::SurfacePoint& point, double stiffness) {
  const auto place =
      place_in_cell(cells.grid().coordinates(point.position), [&](const std::array<int, 3>& cell) {
        return cells.cell_at(cell[0], cell[1], cell[2]) != GridCells::none;
      });
  if (!place) {
    throw meshes::InvalidInput({"lattice.spacing", meshes::to_text(cells.grid().spacing) + " m",
                                "every point of the tip's surface needs a cell near it",
                                "choose a finer lattice"});
  }
  const auto& [lowest, weights] = *place;
  EmbeddedPoint embedded;
  embedded.corners = cells.corners(cells.cells()[cells.cell_at(lowest[0], lowest[1], lowest[2])]);
  embedded.weights = weights;
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
