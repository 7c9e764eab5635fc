#include "lattice/model/cell_lattice.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <compare>
#include <numeric>
#include <stdexcept>

#include "lattice/kernels/stencil.h"

namespace fingertip::lattice::inline model {

using meshes::CubicGrid;
using meshes::CutCell;

namespace {

using CutValues = std::array<double, CellLattice::cut_values>;

/// Coordinate d of corner c, in [-1, 1] from end to end.
double coordinate(int c, int d) {
  return (c >> d & 1) != 0 ? 1.0 : -1.0;
}

/// Pairs of the four parallel edges, along each of three directions.
constexpr int edge_pairs = 18;

/// The variance of the gradients of the four edges along direction d, each weighted with its share
/// of the rubber, as a sum of squares of linear forms in the bilinear modes yz, zx, xy, xyz, one
/// per pair of edges: Var = Σ w_e w_f (g_e - g_f)². An edge at (s, t) across d has the gradient H_d
/// + q_m s + q_n t + q_xyz s t. Slivers, whose edges share very unevenly, lose no digits.
void put_edge_variance(const CornerMoments& moments, double fraction, int d,
                       Eigen::Matrix<double, edge_pairs, 4>& forms) {
  const int first = (d + 1) % 3, second = (d + 2) % 3;
  Eigen::Vector4d weight = Eigen::Vector4d::Zero();
  Eigen::Matrix4d slope = Eigen::Matrix4d::Zero();  // of an edge's (row's) gradient by each mode
  for (int e = 0; e < 4; ++e) {
    const int c = edge_start(std::size_t(d), std::size_t(e));
    const double s = coordinate(c, first), t = coordinate(c, second);
    weight[e] = moments[std::size_t(c)] / fraction + moments[std::size_t(c | 1 << d)] / fraction;
    // Mode m is the product of the coordinates other than m.
    slope(e, second) = s;
    slope(e, first) = t;
    slope(e, 3) = s * t;
  }
  int row = d * edge_pairs / 3;
  for (int e = 0; e < 4; ++e) {
    for (int f = 0; f < e; ++f) {
      forms.row(row++) = std::sqrt(weight[e] * weight[f]) * (slope.row(e) - slope.row(f));
    }
  }
}

}  // namespace

Eigen::Matrix4d mode_root(const CornerMoments& moments) {
  const double fraction = std::accumulate(moments.begin(), moments.end(), 0.0);
  Eigen::Matrix<double, edge_pairs, 4> forms;
  for (int d = 0; d < 3; ++d) put_edge_variance(moments, fraction, d, forms);
  return forms.householderQr().matrixQR().topRows<4>().triangularView<Eigen::Upper>();
}

namespace {

CutValues cut_values_of(const CutCell& cell, double spacing, const CellMaterial& material) {
  const CornerMoments moments = corner_moments(cell);
  const double fraction = std::accumulate(moments.begin(), moments.end(), 0.0);
  CutValues values{fraction};
  for (int d = 0; d < 3; ++d) {
    for (int c = 0; c < 8; ++c) {
      const double share = moments[std::size_t(c)] / fraction;
      values[std::size_t(1 + d)] += share * coordinate(c, d);
      values[std::size_t(4 + d)] += share * coordinate(c, (d + 1) % 3) * coordinate(c, (d + 2) % 3);
    }
  }
  const Eigen::Matrix4d root =
      std::sqrt(0.25 * spacing * spacing * fraction * material.hourglass_modulus) *
      mode_root(moments);
  std::size_t next = 7;
  for (int m = 0; m < 4; ++m) {
    for (int n = m; n < 4; ++n) values[next++] = root(m, n);
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

/// Which block a cell belongs to when some block begins at i = `phase`; blocks follow one another
/// along y, then along x, then along z.
struct Place {
  int k, column, j;

  auto operator<=>(const Place&) const = default;
};

Place place_of(const CutCell& cell, int phase) {
  const int size = int(lanes);
  return {cell.index[2], (cell.index[0] + size - phase) / size, cell.index[1]};
}

using Block = std::vector<const CutCell*>;

/// The cells block by block.
std::vector<Block> blocks_of(const std::vector<CutCell>& cells, int phase) {
  Block sorted;
  for (const CutCell& cell : cells) sorted.push_back(&cell);
  std::stable_sort(sorted.begin(), sorted.end(), [&](const CutCell* a, const CutCell* b) {
    return place_of(*a, phase) < place_of(*b, phase);
  });
  std::vector<Block> blocks;
  for (const CutCell* cell : sorted) {
    if (blocks.empty() || place_of(*blocks.back().front(), phase) != place_of(*cell, phase)) {
      blocks.emplace_back();
    }
    blocks.back().push_back(cell);
  }
  return blocks;
}

bool is_whole(const Block& block) {
  return block.size() == lanes &&
         std::all_of(block.begin(), block.end(), [](const CutCell* c) { return is_whole(*c); });
}

/// Where blocks begin so that they cost least.
int best_phase(const std::vector<CutCell>& cells) {
  constexpr std::size_t whole_cost = 2, cut_cost = 3;  // lattice/MEASUREMENTS.md
  std::array<std::size_t, lanes> costs{};
  for (std::size_t phase = 0; phase < lanes; ++phase) {
    for (const Block& block : blocks_of(cells, int(phase))) {
      costs[phase] += is_whole(block) ? whole_cost : cut_cost;
    }
  }
  return int(std::min_element(costs.begin(), costs.end()) - costs.begin());
}

void add_block(const CubicGrid& grid, const Block& cells, int phase, CellLattice& lattice) {
  const int begin = (place_of(*cells.front(), phase).column - 1) * int(lanes) + phase;
  const std::ptrdiff_t first =
      std::ptrdiff_t(lowest_corner(grid, *cells.front())) - (cells.front()->index[0] - begin);
  CellBlock block{std::uint32_t(first), CellBlock::whole};
  if (!is_whole(cells)) {
    block.cut = std::uint32_t(lattice.cut.size());
    lattice.cut.resize(lattice.cut.size() + CellLattice::cut_values);
    for (const CutCell* cell : cells) {
      const CutValues values = cut_values_of(*cell, grid.spacing, lattice.material);
      const std::size_t lane = std::size_t(cell->index[0] - begin);
      for (std::size_t v = 0; v < values.size(); ++v) {
        lattice.cut[block.cut + v].at[lane] = values[v];
      }
    }
  }
  lattice.blocks.push_back(block);
}

/// Slabs of about as many blocks; `planes`: the first blocks of planes, `end`: that of the last
/// one. The thicker a slab, the more particles are still in a near cache when their second plane
/// comes; but threads take whole slabs, and should get as many each.
std::array<std::vector<CellLattice::Slab>, 2> slabs_of(std::vector<std::uint32_t> planes,
                                                       std::uint32_t end) {
  constexpr std::size_t planes_each = 4, at_once = 8;
  const std::size_t wanted =
      std::max<std::size_t>(1, planes.size() / (planes_each * at_once)) * at_once;
  planes.push_back(end);
  std::array<std::vector<CellLattice::Slab>, 2> slabs;
  std::size_t plane = 0;
  for (std::size_t n = 1; n <= wanted && planes[plane] < end; ++n) {
    const std::uint32_t first = planes[plane];
    const std::size_t target = n * end / wanted;
    do ++plane;
    while (planes[plane] < end && planes[plane] < target);
    slabs[(n - 1) % 2].push_back({first, planes[plane]});
  }
  return slabs;
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
  const int phase = best_phase(cells);
  std::vector<std::uint32_t> planes;  // their first blocks
  int plane = 0;                      // cells begin at 1
  for (const Block& block : blocks_of(cells, phase)) {
    const int k = block.front()->index[2];
    if (k != plane) planes.push_back(std::uint32_t(lattice.blocks.size()));
    plane = k;
    add_block(grid, block, phase, lattice);
  }
  lattice.slabs = slabs_of(planes, std::uint32_t(lattice.blocks.size()));
  return lattice;
}

}  // namespace fingertip::lattice::inline model
