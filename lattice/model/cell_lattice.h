/// Cells that store energy in their deformation, laid out for the vectorised kernel.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lattice/kernels/cell_material.h"
#include "lattice/kernels/lanes.h"
#include "lattice/model/grid_cells.h"
#include "meshes/cells/cubic_grid.h"
#include "meshes/cells/cut_cells.h"

namespace fingertip::lattice::inline model {

/// Immutable. Blocks do not overlap and begin a multiple of `lanes` apart along x: those of a plane
/// are sorted along x, and where they begin at the same x, along y, so that a block mostly follows
/// its neighbour along y and shares a side with it.
struct CellLattice {
  /// Per lane of a cut block, value by value (value v of lane l at cut[block.cut + v].at[l]): the
  /// volume fraction (0: absent), the means over the rubber of x, y, z, yz, zx, xy, the cell being
  /// [-1, 1]³, and the upper triangle, row by row, of the matrix R with RᵀR = a²/4 fraction mu_h
  /// Omega [√N].
  static constexpr std::size_t cut_values = 17;

  CellMaterial material;
  double spacing = 0.0;               ///< a [m]
  std::ptrdiff_t row = 0, plane = 0;  ///< from a grid point to the next along y and z
  std::vector<CellBlock> blocks;
  /// Planes of cells that follow one another along z, as a range [first, last) of blocks. A plane
  /// shares particles with the two beside it alone: slabs of one list share none. The slabs of the
  /// second list fill the gaps between those of the first.
  struct Slab {
    std::uint32_t first = 0, last = 0;
  };
  std::array<std::vector<Slab>, 2> slabs;
  std::vector<kernel::Lanes> cut;

  bool empty() const { return blocks.empty(); }
};

/// R with RᵀR = Omega, upper triangular: |R q|² is the variance of the gradients of a cell's edges,
/// weighted by the rubber they own, for the bilinear modes q in the order yz, zx, xy, xyz.
Eigen::Matrix4d mode_root(const CornerMoments& moments);

/// Lays the cells out; they must be sorted by grid index. The grid must have at least `lanes` - 1
/// points without particles at the end of every row and one layer of them on every other side, so
/// that the kernel may read and write whole blocks; throws std::invalid_argument otherwise.
CellLattice lay_out(const meshes::CubicGrid& grid, const std::vector<meshes::CutCell>& cells,
                    const CellMaterial& material);

}  // namespace fingertip::lattice::inline model
