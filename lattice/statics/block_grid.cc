#include "lattice/statics/block_grid.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>
#include <numeric>

namespace fingertip::lattice::inline statics {

using Eigen::Matrix3d;

namespace {

/// Of the diagonal on coarser grids: at the rim they may have more points than finer ones tell
/// apart, which would leave the matrix singular.
constexpr double coarse_excess = 1e-7;
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// Rows worth another thread.
constexpr std::size_t rows_at_once = 100;

/// Of the coarser grid, at this place or next below it.
GridPlace coarse_place(const GridPlace& place) {
  return {place[0] >> 1, place[1] >> 1, place[2] >> 1};
}

/// That of the place itself.
constexpr std::size_t own_rank = 13;

std::size_t rank(const GridPlace& from, const GridPlace& to) {
  return std::size_t((to[0] - from[0] + 1) + 3 * (to[1] - from[1] + 1) + 9 * (to[2] - from[2] + 1));
}
GridPlace moved(const GridPlace& place, std::size_t rank) {
  return {place[0] + int(rank % 3) - 1, place[1] + int(rank / 3 % 3) - 1,
          place[2] + int(rank / 9) - 1};
}

/// Rows by place.
class RowTable {
 public:
  explicit RowTable(const std::vector<GridPlace>& places) {
    GridPlace last = first_ = places.front();
    for (const GridPlace& place : places)
      for (std::size_t d = 0; d < 3; ++d) {
        first_[d] = std::min(first_[d], place[d]);
        last[d] = std::max(last[d], place[d]);
      }
    for (std::size_t d = 0; d < 3; ++d) size_[d] = std::size_t(last[d] - first_[d] + 1);
    rows_.assign(size_[0] * size_[1] * size_[2], none);
    for (std::uint32_t row = 0; row < places.size(); ++row) rows_[index(places[row])] = row;
  }
  std::uint32_t at(const GridPlace& place) const { return rows_[index(place)]; }

 private:
  std::size_t index(const GridPlace& place) const {
    const auto along = [&](std::size_t d) { return std::size_t(place[d] - first_[d]); };
    return along(0) + size_[0] * (along(1) + size_[1] * along(2));
  }

  GridPlace first_{};
  std::array<std::size_t, 3> size_{};
  std::vector<std::uint32_t> rows_;
};

/// The coarser grid's points; and of every row of `fine` its parents.
std::vector<GridPlace> coarse_places(BlockGrid& fine) {
  std::vector<GridPlace> parents;
  fine.first_parent.assign(1, 0);
  for (const GridPlace& place : fine.places) {
    const GridPlace low = coarse_place(place);
    for (int k = 0; k <= (place[2] & 1); ++k)
      for (int j = 0; j <= (place[1] & 1); ++j)
        for (int i = 0; i <= (place[0] & 1); ++i)
          parents.push_back({low[0] + i, low[1] + j, low[2] + k});
    fine.first_parent.push_back(std::uint32_t(parents.size()));
  }
  std::vector<GridPlace> places = parents;
  std::ranges::sort(places);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  std::ranges::stable_sort(places, {}, parity);
  const RowTable rows(places);
  for (const GridPlace& place : parents) fine.parent.push_back(rows.at(place));
  return places;
}

/// What blocks from `from` to `to` make of the solution.
Four pull(const BlockGrid& grid, std::uint32_t from, std::uint32_t to) {
  Four sum = Four::Zero();
  for (std::uint32_t e = from; e < to; ++e)
    sum += grid.blocks.product(e, grid.solution[grid.column[e]]);
  return sum;
}

/// Rows that share no block, by all of a team.
template <typename Visit>
void for_rows(std::uint32_t begin, std::uint32_t end, Team& team, const Visit& visit) {
  team.split(end - begin, rows_at_once, [&](std::size_t from, std::size_t to) {
    for (std::size_t p = from; p < to; ++p) visit(std::uint32_t(begin + p));
  });
}

}  // namespace

void size_fields(BlockGrid& grid) {
  for (std::uint32_t p = 0; p < grid.rows(); ++p)
    ++grid.begins[std::size_t(parity(grid.places[p])) + 1];
  std::partial_sum(grid.begins.begin(), grid.begins.end(), grid.begins.begin());
  grid.share.resize(grid.rows());
  grid.values.assign(grid.column.size(), Matrix3d::Zero());
  grid.blocks.resize(grid.column.size());
  grid.inverse.resize(grid.rows());
  grid.load.assign(grid.rows(), Four::Zero());
  grid.solution.assign(grid.rows(), Four::Zero());
  grid.free.assign(grid.rows(), Four::Ones());
}

BlockGrid coarsened(BlockGrid& fine) {
  BlockGrid coarse;
  coarse.places = coarse_places(fine);
  std::array<std::uint32_t, ranks> nothing;
  nothing.fill(none);
  std::vector<std::array<std::uint32_t, ranks>> rows_around(coarse.rows(), nothing);
  for (std::size_t p = 0; p < fine.rows(); ++p)
    for (std::uint32_t e = fine.first[p]; e < fine.first[p + 1]; ++e)
      for (const std::uint32_t from : fine.parents(p))
        for (const std::uint32_t to : fine.parents(fine.column[e]))
          rows_around[from][rank(coarse.places[from], coarse.places[to])] = to;
  coarse.block_at.assign(coarse.rows(), nothing);
  coarse.first.push_back(0);
  for (std::uint32_t p = 0; p < coarse.rows(); ++p) {
    const auto append = [&](std::size_t n) {
      coarse.block_at[p][n] = std::uint32_t(coarse.column.size());
      coarse.column.push_back(rows_around[p][n]);
    };
    append(own_rank);
    for (const bool later : {false, true}) {
      if (later) coarse.later.push_back(std::uint32_t(coarse.column.size()));
      for (std::size_t n = 0; n < ranks; ++n)
        if (rows_around[p][n] != none && n != own_rank && (rows_around[p][n] > p) == later)
          append(n);
    }
    coarse.first.push_back(std::uint32_t(coarse.column.size()));
  }
  size_fields(coarse);
  return coarse;
}

void restrict_matrix(const BlockGrid& fine, BlockGrid& coarse) {
  std::ranges::fill(coarse.values, Matrix3d::Zero());
  for (std::size_t p = 0; p < fine.rows(); ++p) {
    const GridPlace base = coarse_place(fine.places[p]);
    std::array<Matrix3d, ranks> sums;  // per coarse place around the base
    std::array<bool, ranks> any{};
    for (std::uint32_t e = fine.first[p]; e < fine.first[p + 1]; ++e) {
      Matrix3d block = fine.values[e];
      if (e == fine.first[p]) block.diagonal().array() *= fine.free[p].head<3>().cast<double>();
      const auto parents = fine.parents(fine.column[e]);
      block /= double(parents.size());
      for (const std::uint32_t to : parents) {
        const std::size_t n = rank(base, coarse.places[to]);
        if (any[n]) {
          sums[n] += block;
        } else {
          sums[n] = block;
        }
        any[n] = true;
      }
    }
    const auto parents = fine.parents(p);
    for (std::size_t n = 0; n < ranks; ++n) {
      if (!any[n]) continue;
      const Matrix3d block = sums[n] / double(parents.size());
      const GridPlace place = moved(base, n);
      for (const std::uint32_t from : parents)
        coarse.values[coarse.block_at[from][rank(coarse.places[from], place)]] += block;
    }
  }
  for (std::size_t p = 0; p < coarse.rows(); ++p)
    for (int i = 0; i < 3; ++i) {
      double& own = coarse.values[coarse.first[p]](i, i);
      coarse.free[p][i] = own == 0.0 ? 0.0F : 1.0F;  // all that it moves is held
      own = own == 0.0 ? 1.0 : own * (1.0 + coarse_excess);
    }
}

bool prepare_sweeps(BlockGrid& grid) {
  for (std::size_t e = 0; e < grid.values.size(); ++e) grid.blocks.set(e, grid.values[e]);
  for (std::size_t p = 0; p < grid.rows(); ++p) {
    const Eigen::LLT<Matrix3d> factor(grid.values[grid.first[p]]);
    if (factor.info() != Eigen::Success) return false;
    grid.inverse.set(p, factor.solve(Matrix3d::Identity()));
  }
  return true;
}

void sweep_forward(BlockGrid& grid, Team& team) {
  for (std::size_t own = 0; own < 8; ++own)
    for_rows(grid.begins[own], grid.begins[own + 1], team, [&](std::uint32_t p) {
      grid.solution[p] =
          grid.inverse.product(p, grid.load[p] - pull(grid, grid.first[p] + 1, grid.later[p]));
    });
}

void restrict_residual(BlockGrid& grid, BlockGrid& coarse, Team& team) {
  for_rows(0, std::uint32_t(grid.rows()), team, [&](std::uint32_t p) {
    grid.share[p] = grid.free[p] * pull(grid, grid.later[p], grid.first[p + 1]) /
                    -float(grid.parents(p).size());
  });
  std::ranges::fill(coarse.load, Four::Zero());
  for (std::size_t p = 0; p < grid.rows(); ++p)
    for (const std::uint32_t to : grid.parents(p)) coarse.load[to] += grid.share[p];
  for (std::size_t p = 0; p < coarse.rows(); ++p) coarse.load[p] *= coarse.free[p];
}

void add_interpolated(const BlockGrid& coarse, BlockGrid& grid, Team& team) {
  for_rows(0, std::uint32_t(grid.rows()), team, [&](std::uint32_t p) {
    const auto parents = grid.parents(p);
    Four sum = Four::Zero();
    for (const std::uint32_t from : parents) sum += coarse.solution[from];
    grid.solution[p] += grid.free[p] * sum / float(parents.size());
  });
}

void sweep_backward(BlockGrid& grid, Team& team) {
  for (std::size_t own = 8; own-- > 0;)
    for_rows(grid.begins[own], grid.begins[own + 1], team, [&](std::uint32_t p) {
      grid.solution[p] =
          grid.inverse.product(p, grid.load[p] - pull(grid, grid.first[p] + 1, grid.first[p + 1]));
    });
}

}  // namespace fingertip::lattice::inline statics
