/// Cells of a cubic grid, whole or cut by the tip's surface, and the particles at their corners.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "lattice/kernels/stencil.h"
#include "meshes/cells/cubic_grid.h"
#include "meshes/cells/cut_cells.h"

namespace fingertip::lattice::inline model {

/// Per corner c of a cell (bits 0, 1, 2 of c step along the grid's x, y, z) the integral over the
/// unit cell of chi N_c, chi = 1 in the rubber and N_c the corner's trilinear shape function. All
/// positive; their sum is the cell's fraction.
using CornerMoments = std::array<double, 8>;

/// From the cell's monomial moments. What these miss by (1e-7 of a cell, which is more than some
/// corners of a sliver have) may not turn an integral negative: each is at least 1e-9 of the
/// fraction.
CornerMoments corner_moments(const meshes::CutCell& cell);

/// How much a cell owns of the spring that starts at its corner `corner` in `direction`, as the
/// integral over the unit cell of chi times the linear shape functions of the coordinates across
/// the direction: chi N_j N_k for an edge, chi N_k for a face diagonal, chi for a body diagonal. A
/// whole cell owns cell_share; the four edges along one direction own the cell's fraction together.
double spring_share(const CornerMoments& moments, int corner, const Direction& direction);

/// Mean over the rubber of the shape functions' gradients, one column per corner, in the directions
/// that are the columns of `axes` [1/m]. The slope of N_c along x is that of its edge along x,
/// ± N_j N_k / a: its mean is the edge's share over the fraction.
Eigen::Matrix<double, 3, 8> mean_gradients(const CornerMoments& moments, double spacing,
                                           const Eigen::Matrix3d& axes);

/// Immutable. Particles are the corners of the cells, numbered by increasing grid index.
class GridCells {
 public:
  /// Number of a cell or particle that does not exist.
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  GridCells(const meshes::CubicGrid& grid, std::vector<meshes::CutCell> cells);

  const meshes::CubicGrid& grid() const { return grid_; }
  const std::vector<meshes::CutCell>& cells() const { return cells_; }
  std::size_t particles() const { return point_of_.size(); }
  /// Grid index of a particle.
  std::uint32_t point(std::size_t particle) const { return point_of_[particle]; }
  meshes::Vector3 rest_position(std::size_t particle) const;  ///< [m]
  /// Number of the particle at a grid point, or none.
  std::uint32_t particle_at(std::size_t point) const { return particle_at_[point]; }
  /// Position in cells() of the cell whose lowest corner is (i, j, k), or none; any integers.
  std::uint32_t cell_at(int i, int j, int k) const;
  /// Particles at a cell's corners.
  std::array<std::uint32_t, 8> corners(const meshes::CutCell& cell) const;

 private:
  meshes::CubicGrid grid_;
  std::vector<meshes::CutCell> cells_;
  std::vector<std::uint32_t> point_of_;     ///< per particle
  std::vector<std::uint32_t> particle_at_;  ///< per grid point
  std::vector<std::uint32_t> cell_at_;      ///< per grid point
};

/// A block of cells wholly in the rubber, counts[0] x counts[1] x counts[2] from `lowest` on.
std::vector<meshes::CutCell> whole_cells(const std::array<int, 3>& lowest,
                                         const std::array<int, 3>& counts);

/// Per direction of the half stencil and grid point: what the cells own together of the spring from
/// the point to its neighbour (spring_share).
std::array<std::vector<double>, directions> spring_shares(const GridCells& cells);

/// The cells that hang together face to face in one piece, in their order. Cells that share less
/// than a face would be hinged. Pieces that hold less than 1e-4 of the rubber together are left
/// out; throws InvalidInput when they hold more.
std::vector<meshes::CutCell> largest_piece(const meshes::CubicGrid& grid,
                                           const std::vector<meshes::CutCell>& cells);

}  // namespace fingertip::lattice::inline model
