/// Points of the tip's true surfaces, embedded among the particles around them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>

#include "lattice/model/grid_cells.h"
#include "meshes/cells/surface_points.h"

namespace fingertip::lattice::inline model {

/// A point that moves with particles: x = rest + Σ weight_c u(corner_c), Σ weight_c = 1.
struct EmbeddedPoint {
  std::array<std::uint32_t, 8> corners{};
  std::array<double, 8> weights{};
  meshes::Vector3 rest = meshes::Vector3::Zero();    ///< on the true surface [m]
  meshes::Vector3 normal = meshes::Vector3::Zero();  ///< out of the rubber, unit length
  double area = 0.0;                                 ///< of the surface it stands for [m²]
  double stiffness = 0.0;                            ///< of its tie to rod or plane [N/m]
};

/// A place in a cell of a grid, by trilinear weights of its corners (CornerMoments).
struct PlaceInCell {
  std::array<int, 3> lowest{};  ///< corner of the cell
  std::array<double, 8> weights{};
};
/// A place at grid coordinates `at` in the cell that holds it, or where that is none of those there
/// in the nearest of the 26 around it that is: the weights then extrapolate, and none exceeds 8 in
/// magnitude. Nothing where none is there either.
std::optional<PlaceInCell> place_in_cell(
    const meshes::Vector3& at, const std::function<bool(const std::array<int, 3>&)>& is_there);

/// The surface point embedded in the eight corners of its cell by trilinear weights, its stiffness
/// `stiffness` [Pa/m] times its area. A cell that was left out is none of those there
/// (place_in_cell). Throws InvalidInput when there is none.
EmbeddedPoint tie(const GridCells& cells, const meshes::SurfacePoint& point, double stiffness);

/// `particle` itself as an embedded point.
EmbeddedPoint tie_to_particle(std::uint32_t particle, const meshes::Vector3& rest,
                              const meshes::Vector3& normal, double area, double stiffness);

/// The surface that a point stands for, at rest, as seen along a unit vector [m²]; at least a
/// millionth of it, so that there are tractions on what is seen from the side.
inline double seen_area(const EmbeddedPoint& point, const meshes::Vector3& along) {
  return point.area * std::max(std::abs(point.normal.dot(along)), 1e-6);
}

/// Where the corners of its cell have gone by these displacements [m] the surface that a point
/// stands for, its area times its outward normal [m²]: J F^-T N area, F at the point. `edges`: the
/// cell's at rest, as columns [m].
meshes::Vector3 carried_surface(const EmbeddedPoint& point,
                                const Eigen::Matrix<double, 3, 8>& displacements,
                                const Eigen::Matrix3d& edges);

}  // namespace fingertip::lattice::inline model
