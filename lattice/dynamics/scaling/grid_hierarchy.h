/// The points of a lattice and of ever coarser grids over them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lattice/dynamics/scaling/sweeps.h"
#include "lattice/model/model.h"

namespace fingertip::lattice::inline dynamics::inline scaling {

/// One grid: its points, and how fields on it are passed on to the grid of twice the spacing, whose
/// point i lies at 2 (i - lead) - 1 along every axis. In two sweeps: along y and z onto a sheet,
/// rows of the coarser grid with the points of this one, and then along x.
struct GridLevel {
  std::array<int, 3> size{};  ///< with a layer or more of empty points on every side
  /// Where the planes through the finger's axis lie; on the coarser grid, too, unless it is even.
  std::array<int, 3> middle{};
  std::array<int, 3> lead{};             ///< 0 or 1, so that every grid's middle is odd; along x 0
  std::array<std::ptrdiff_t, 3> next{};  ///< to the next point along x, y, z
  std::vector<std::uint8_t> is_node;     ///< per point: 1 at a particle, or at what carries one
  std::vector<std::uint32_t> blocks;     ///< first points of runs of `lanes` that cover the nodes
  /// Per axis: nodes on the mirror plane across it, at index 1 of every grid; they do not move
  /// along it. The coarser grid's are interpolated to it alone.
  std::array<std::vector<std::uint32_t>, 3> held;
  /// Per block: where the up to four rows of the sheet start from which its points are interpolated
  /// with equal weights (some of them the same).
  std::vector<std::array<std::uint32_t, 4>> parents;
  std::size_t sheet_points = 0;
  std::vector<sweeps::SheetBlock> sheet_blocks;  ///< cover what the nodes are restricted to
  std::vector<std::uint32_t>
      coarser_sheets;  ///< per block of the coarser grid: 2i - 1 on the sheet

  std::size_t points() const { return is_node.size(); }
};

/// From the particles to a handful of points. A coarse point is a node if a finer node is
/// interpolated from it. Those of a whole tip are mirror images where the tip is, and those of its
/// parts are parts of them (Sector).
class GridHierarchy {
 public:
  explicit GridHierarchy(const LatticeModel& model);
  const std::vector<GridLevel>& levels() const { return levels_; }

 private:
  std::vector<GridLevel> levels_;
};

/// The points of the coarser grid from which point `p` of a level is interpolated, trilinearly.
struct CoarsePoints {
  int count = 0;  ///< of them, at most eight, with equal weights
  std::array<std::uint32_t, 8> point{};
};
CoarsePoints coarse_points(const GridLevel& fine, const GridLevel& coarse, std::uint32_t p);
}  // namespace fingertip::lattice::inline dynamics::inline scaling
