#include "lattice/cells/cell_lattice.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "lattice/cells/grid_cells.h"
#include "lattice/stencil.h"

namespace fingertip::lattice {

using meshes::CubicGrid;
using meshes::CutCell;

namespace {

using CutValues = std::array<double, CellLattice::cut_values>;

/// Coordinate d of corner c about the cell's centre.
double coordinate(int c, int d) {
  return (c >> d & 1) != 0 ? 0.5 : -0.5;
}

/// Adds the variance of the gradients of the four edges along direction d, each weighted with its
/// share of the rubber, as a quadratic form in the bilinear modes yz, zx, xy, xyz. An edge at
/// (s, t) across d has the gradient H_d + q_m s + q_n t + q_xyz s t. Summed over pairs of edges,
/// so that slivers, whose edges share very unevenly, lose no digits.
void add_edge_variance(const CornerMoments& moments, double fraction, int d,
                       std::array<std::array<double, 4>, 4>& omega) {
  const int first = (d + 1) % 3, second = (d + 2) % 3;
  std::array<double, 4> weight{};
  std::array<std::array<double, 4>, 4> slope{};  // of an edge's gradient by each mode
  for (int c = 0; c < 8; ++c) {
    const std::size_t edge = std::size_t((c >> first & 1) + 2 * (c >> second & 1));
    const double s = coordinate(c, first), t = coordinate(c, second);
    weight[edge] += moments[std::size_t(c)] / fraction;
    // Mode m is the product of the coordinates other than m.
    slope[edge][std::size_t(second)] = s;
    slope[edge][std::size_t(first)] = t;
    slope[edge][3] = s * t;
  }
  for (std::size_t e = 0; e < 4; ++e) {
    for (std::size_t f = 0; f < e; ++f) {
      for (std::size_t m = 0; m < 4; ++m) {
        for (std::size_t n = 0; n < 4; ++n) {
          omega[m][n] +=
              weight[e] * weight[f] * (slope[e][m] - slope[f][m]) * (slope[e][n] - slope[f][n]);
        }
      }
    }
  }
}

CutValues cut_values_of(const CutCell& cell) {
  const CornerMoments moments = corner_moments(cell);
  const double fraction = std::accumulate(moments.begin(), moments.end(), 0.0);
  CutValues values{fraction};
  std::array<std::array<double, 4>, 4> omega{};
  for (int d = 0; d < 3; ++d) {
    for (int c = 0; c < 8; ++c) {
      const double share = moments[std::size_t(c)] / fraction;
      values[std::size_t(1 + d)] += share * coordinate(c, d);
      values[std::size_t(4 + d)] += share * coordinate(c, (d + 1) % 3) * coordinate(c, (d + 2) % 3);
    }
    add_edge_variance(moments, fraction, d, omega);
  }
  std::size_t next = 7;
  for (std::size_t m = 0; m < 4; ++m) {
    for (std::size_t n = m; n < 4; ++n) values[next++] = omega[m][n];
  }
  return values;
}

bool is_whole(const CutCell& cell) {
  return cell.moments == std::array<double, 8>{1.0, 0.5, 0.5, 0.25, 0.5, 0.25, 0.25, 0.125};
}

std::size_t lowest_corner(const CubicGrid& grid, const CutCell& cell) {
  return grid.index(cell.index[0], cell.index[1], cell.index[2]);
}

void check(const CubicGrid& grid, const std::vector<CutCell>& cells) {
  if (grid.points() >= CellBlock::whole) throw std::invalid_argument("lay_out: too many points");
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto& index = cells[i].index;
    const bool room = *std::min_element(index.begin(), index.end()) >= 1 &&
                      index[0] + 1 + int(lanes) <= grid.size[0] && index[1] + 2 < grid.size[1] &&
                      index[2] + 2 < grid.size[2];
    if (!room) throw std::invalid_argument("lay_out: too few points around the cells");
    if (i > 0 && lowest_corner(grid, cells[i]) <= lowest_corner(grid, cells[i - 1])) {
      throw std::invalid_argument("lay_out: cells are not sorted");
    }
  }
}

/// Makes the cells [begin, end), which follow one another within `lanes`, a block.
void add_block(const CubicGrid& grid, const CutCell* begin, const CutCell* end,
               CellLattice& lattice) {
  CellBlock block{std::uint32_t(lowest_corner(grid, *begin)), CellBlock::whole};
  if (end - begin != std::ptrdiff_t(lanes) || !std::all_of(begin, end, is_whole)) {
    block.cut = std::uint32_t(lattice.cut.size());
    lattice.cut.resize(lattice.cut.size() + CellLattice::cut_values * lanes, 0.0);
    for (const CutCell* cell = begin; cell != end; ++cell) {
      const CutValues values = cut_values_of(*cell);
      double* lane = lattice.cut.data() + block.cut + (cell->index[0] - begin->index[0]);
      for (std::size_t v = 0; v < values.size(); ++v) lane[v * lanes] = values[v];
    }
  }
  lattice.blocks.push_back(block);
}

/// Every second plane first, and so on within the halves: threads take contiguous ranges of planes,
/// and planes near the tip's pole hold fewer cells than others.
void interleave(std::vector<CellLattice::Plane>& planes) {
  if (planes.size() < 3) return;
  std::vector<CellLattice::Plane> even, odd;
  for (std::size_t p = 0; p < planes.size(); ++p) (p % 2 == 0 ? even : odd).push_back(planes[p]);
  interleave(even);
  interleave(odd);
  std::copy(odd.begin(), odd.end(), std::copy(even.begin(), even.end(), planes.begin()));
}

}  // namespace

CellLattice lay_out(const CubicGrid& grid, const std::vector<CutCell>& cells,
                    const CellMaterial& material) {
  check(grid, cells);
  CellLattice lattice;
  lattice.material = material;
  lattice.spacing = grid.spacing;
  lattice.row = grid.size[0];
  lattice.plane = lattice.row * grid.size[1];
  const CutCell* const last = cells.data() + cells.size();
  for (const CutCell* begin = cells.data(); begin != last;) {
    const std::size_t limit = lowest_corner(grid, *begin) + lanes;
    const CutCell* end = begin;
    // The free points at the end of every row keep a block from reaching the next.
    while (end != last && lowest_corner(grid, *end) < limit) ++end;
    const int k = begin->index[2];
    auto& planes = lattice.planes[std::size_t(k % 2)];
    const std::uint32_t block = std::uint32_t(lattice.blocks.size());
    const bool opens = block == 0 || (begin - 1)->index[2] != k;
    if (opens) planes.push_back({block, block});
    ++planes.back().last;
    add_block(grid, begin, end, lattice);
    begin = end;
  }
  for (auto& planes : lattice.planes) interleave(planes);
  return lattice;
}

}  // namespace fingertip::lattice
