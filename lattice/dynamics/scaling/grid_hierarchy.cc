#include "lattice/dynamics/scaling/grid_hierarchy.h"

#include <algorithm>
#include <limits>

#include "lattice/kernels/stencil.h"

namespace fingertip::lattice::inline dynamics::inline scaling {

namespace {

constexpr int coarsest = 2;  // intervals along the longest side, of the whole tip

/// On one axis: the first and last of the one or two coarse points around `fine`.
std::array<int, 2> around(int fine, int lead) {
  return {(fine + 1) / 2 + lead, fine / 2 + 1 + lead};
}

/// On one axis: the point at which a coarse one lies.
int finer(int coarse, int lead) {
  return 2 * (coarse - lead) - 1;
}

std::array<int, 3> place(const GridLevel& level, std::uint32_t p) {
  const int nx = level.size[0], ny = level.size[1];
  return {int(p) % nx, int(p) / nx % ny, int(p) / nx / ny};
}

std::size_t point(const std::array<int, 3>& size, int x, int y, int z) {
  return (std::size_t(z) * std::size_t(size[1]) + std::size_t(y)) * std::size_t(size[0]) +
         std::size_t(x);
}

/// Runs of `lanes` points that cover the marked ones.
std::vector<std::uint32_t> runs(const std::vector<std::uint8_t>& marked) {
  std::vector<std::uint32_t> first;
  for (std::size_t p = 0; p < marked.size(); ++p) {
    if (marked[p] == 0) continue;
    first.push_back(std::uint32_t(p));
    p += lanes - 1;
  }
  return first;
}

void set_strides(GridLevel& level) {
  level.next = {1, level.size[0], std::ptrdiff_t(level.size[0]) * level.size[1]};
}

/// Sees to it that the coarser grid's middle is odd where this one's is. Along rows nothing is
/// mirrored.
void set_lead(GridLevel& level) {
  for (std::size_t d = 1; d < 3; ++d) level.lead[d] = level.middle[d] % 4 == 3 ? 1 : 0;
}

/// Room behind the last plane for what the sweeps read beyond it: a plane, and of it the next row.
std::size_t stored_points(const std::array<int, 3>& size) {
  return std::size_t(size[0]) * (std::size_t(size[1]) * std::size_t(size[2] + 1) + 1) + 2 * lanes;
}

GridLevel particles(const LatticeModel& model) {
  GridLevel level;
  level.size = model.grid.size;
  set_strides(level);
  level.is_node = model.is_particle;
  level.is_node.resize(stored_points(level.size), 0);
  level.blocks = model.blocks;
  level.held = model.held;
  level.middle = model.grid.nearest(meshes::Vector3::Zero());
  set_lead(level);
  return level;
}

GridLevel coarsened(const GridLevel& fine) {
  GridLevel coarse;
  coarse.size = {(fine.size[0] - row_margin) / 2 + 2 + row_margin,
                 fine.size[1] / 2 + 2 + fine.lead[1], fine.size[2] / 2 + 2 + fine.lead[2]};
  for (std::size_t d = 0; d < 3; ++d) coarse.middle[d] = (fine.middle[d] + 1) / 2 + fine.lead[d];
  set_strides(coarse);
  set_lead(coarse);
  coarse.is_node.assign(stored_points(coarse.size), 0);
  for (const std::uint32_t block : fine.blocks) {
    for (std::uint32_t p = block; p < block + lanes; ++p) {
      if (fine.is_node[p] == 0) continue;
      const CoarsePoints from = coarse_points(fine, coarse, p);
      for (int n = 0; n < from.count; ++n) coarse.is_node[from.point[std::size_t(n)]] = 1;
    }
  }
  coarse.blocks = runs(coarse.is_node);
  for (std::size_t d = 0; d < 3; ++d) {
    if (fine.held[d].empty()) continue;
    for (std::uint32_t p = 0; p < coarse.is_node.size(); ++p)
      if (coarse.is_node[p] != 0 && place(coarse, p)[d] == 1) coarse.held[d].push_back(p);
  }
  return coarse;
}

void connect(GridLevel& fine, const GridLevel& coarse) {
  const std::array<int, 3> sheet{std::max(fine.size[0], 2 * coarse.size[0] + 2), coarse.size[1],
                                 coarse.size[2]};
  fine.sheet_points = stored_points(sheet);
  std::vector<std::uint8_t> marked(fine.sheet_points, 0);
  for (const std::uint32_t block : fine.blocks) {
    const auto [x, y, z] = place(fine, block);
    std::array<std::uint32_t, 4> parents{};
    for (std::size_t n = 0; n < 4; ++n) {
      const int j = around(y, fine.lead[1])[n & 1], k = around(z, fine.lead[2])[n >> 1];
      parents[n] = std::uint32_t(point(sheet, x, j, k));
      for (std::uint32_t i = 0; i < lanes; ++i)
        if (fine.is_node[block + i] != 0) marked[parents[n] + i] = 1;
    }
    fine.parents.push_back(parents);
  }
  for (const std::uint32_t first : runs(marked)) {
    const int x = int(first) % sheet[0], y = int(first) / sheet[0] % sheet[1],
              z = int(first) / sheet[0] / sheet[1];
    const int row = finer(y, fine.lead[1]), plane = finer(z, fine.lead[2]);
    fine.sheet_blocks.push_back({first, std::uint32_t(point(fine.size, x, row, plane))});
  }
  for (const std::uint32_t block : coarse.blocks) {
    const auto [x, y, z] = place(coarse, block);
    fine.coarser_sheets.push_back(std::uint32_t(point(sheet, finer(x, fine.lead[0]), y, z)));
  }
}

/// Intervals between nodes along the longest side, of the whole of what mirror planes divide.
int longest(const GridLevel& level) {
  std::array<int, 3> first, last{};
  first.fill(std::numeric_limits<int>::max());
  for (std::uint32_t p = 0; p < level.points(); ++p) {
    if (level.is_node[p] == 0) continue;
    const std::array<int, 3> at = place(level, p);
    for (std::size_t d = 0; d < 3; ++d) {
      first[d] = std::min(first[d], at[d]);
      last[d] = std::max(last[d], at[d]);
    }
  }
  int found = 0;
  for (std::size_t d = 0; d < 3; ++d)
    found = std::max(found, (level.held[d].empty() ? 1 : 2) * (last[d] - first[d]));
  return found;
}

}  // namespace

CoarsePoints coarse_points(const GridLevel& fine, const GridLevel& coarse, std::uint32_t p) {
  const auto [x, y, z] = place(fine, p);
  const auto across = around(x, fine.lead[0]), along = around(y, fine.lead[1]),
             up = around(z, fine.lead[2]);
  CoarsePoints found;
  for (int k = up[0]; k <= up[1]; ++k)
    for (int j = along[0]; j <= along[1]; ++j)
      for (int i = across[0]; i <= across[1]; ++i)
        found.point[std::size_t(found.count++)] = std::uint32_t(point(coarse.size, i, j, k));
  return found;
}

GridHierarchy::GridHierarchy(const LatticeModel& model) {
  levels_.push_back(particles(model));
  while (longest(levels_.back()) > coarsest) {
    GridLevel coarse = coarsened(levels_.back());
    connect(levels_.back(), coarse);
    levels_.push_back(std::move(coarse));
  }
}

}  // namespace fingertip::lattice::inline dynamics::inline scaling
