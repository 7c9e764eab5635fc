#include "lattice/statics/block_multigrid.h"

#include <Eigen/CholmodSupport>
#include <algorithm>
#include <numeric>
#include <vector>

#include "lattice/statics/block_grid.h"
#include "lattice/statics/factor_memory.h"

namespace fingertip::lattice::inline statics {

using Eigen::Matrix3d;
using Eigen::VectorXd;

namespace {

/// Unknowns that a coarsest grid may have.
constexpr std::size_t most_factorised = 500;

}  // namespace

struct BlockMultigrid::Implementation {
  Implementation(const ElasticSystem& system, const Team& own_team);
  void take_pattern(const Tangent& pattern);
  void take_values(const Tangent& matrix, double shift);
  Tangent lower_triangle() const;
  bool factorise(const Tangent& matrix, double shift);
  void cycle(std::size_t level);
  void solve_coarsest();

  Team team;
  std::vector<BlockGrid> grids;       ///< none if the matrix itself is factorised
  std::vector<std::uint32_t> row_of;  ///< of a particle on the finest grid
  /// Of the tangent's blocks below the diagonal, in its order: where it stands, and transposed.
  std::vector<std::array<std::uint32_t, 2>> blocks_of;
  Eigen::CholmodSupernodalLLT<Tangent, Eigen::Lower> factor;
};

BlockMultigrid::Implementation::Implementation(const ElasticSystem& system, const Team& own_team)
    : team(own_team) {
  const LatticeBody& body = system.body();
  const Tangent pattern = system.empty_tangent();
  factor.cholmod().print = 0;
  if (!body.places.empty() && std::size_t(body.unknowns()) > most_factorised) {
    std::vector<std::uint32_t> order(body.places.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t p) { return parity(body.places[p]); });
    BlockGrid& finest = grids.emplace_back();
    row_of.resize(order.size());
    for (std::uint32_t row = 0; row < order.size(); ++row) {
      row_of[order[row]] = row;
      finest.places.push_back(body.places[order[row]]);
    }
    take_pattern(pattern);
    for (std::size_t i = 0; i < body.fixed.size(); ++i)
      if (body.fixed[i] != 0) finest.free[row_of[i / 3]][int(i % 3)] = 0.0F;
    while (3 * grids.back().rows() > most_factorised) {
      BlockGrid coarse = coarsened(grids.back());
      grids.push_back(std::move(coarse));
    }
  }
  factor.analyzePattern(grids.empty() ? pattern : lower_triangle());
  require_memory(factor.cholmod(), pattern.rows());
}

void BlockMultigrid::Implementation::take_pattern(const Tangent& pattern) {
  BlockGrid& grid = grids.front();
  std::vector<std::array<std::uint32_t, 2>> ends;  // of blocks: their row and column
  for (std::size_t q = 0; q < row_of.size(); ++q)
    for (int e = pattern.outerIndexPtr()[3 * q] + 3; e < pattern.outerIndexPtr()[3 * q + 1]; e += 3)
      ends.push_back({row_of[std::size_t(pattern.innerIndexPtr()[e]) / 3], row_of[q]});
  std::vector<std::uint32_t> earlier(grid.rows(), 0), later(grid.rows(), 0);
  for (const auto& [p, q] : ends) {
    ++earlier[std::max(p, q)];
    ++later[std::min(p, q)];
  }
  grid.first.push_back(0);
  std::vector<std::uint32_t> next;
  for (std::size_t row = 0; row < grid.rows(); ++row) {
    next.push_back(grid.first.back() + 1);
    grid.later.push_back(next.back() + earlier[row]);
    grid.first.push_back(grid.later.back() + later[row]);
  }
  std::vector<std::uint32_t> next_later = grid.later;
  grid.column.resize(grid.first.back());
  for (std::uint32_t row = 0; row < grid.rows(); ++row) grid.column[grid.first[row]] = row;
  const auto append = [&](std::uint32_t row, std::uint32_t column) {
    const std::uint32_t place = column < row ? next[row]++ : next_later[row]++;
    grid.column[place] = column;
    return place;
  };
  for (const auto& [p, q] : ends) blocks_of.push_back({append(p, q), append(q, p)});
  size_fields(grid);
}

void BlockMultigrid::Implementation::take_values(const Tangent& matrix, double shift) {
  BlockGrid& grid = grids.front();
  const int* outer = matrix.outerIndexPtr();
  auto next = blocks_of.begin();
  for (std::size_t q = 0; q < row_of.size(); ++q) {
    // A column's entries: the diagonal block's below it, then three per block.
    const auto column = [&](int j) {
      return matrix.valuePtr() + outer[3 * q + std::size_t(j)] - j;
    };
    Matrix3d& own = grid.values[grid.first[row_of[q]]];
    for (int j = 0; j < 3; ++j)
      for (int i = j; i < 3; ++i) own(i, j) = own(j, i) = column(j)[i];
    own.diagonal().array() += shift;
    const int entries = outer[3 * q + 1] - outer[3 * q];
    for (int e = 3; e < entries; e += 3, ++next) {
      Matrix3d& block = grid.values[next->front()];
      for (int j = 0; j < 3; ++j) block.col(j) = Eigen::Map<const Eigen::Vector3d>(column(j) + e);
      grid.values[next->back()] = block.transpose();
    }
  }
}

/// Of the coarsest matrix.
Tangent BlockMultigrid::Implementation::lower_triangle() const {
  const BlockGrid& grid = grids.back();
  std::vector<Eigen::Triplet<double>> entries;
  for (std::uint32_t p = 0; p < grid.rows(); ++p)
    for (std::uint32_t e = grid.first[p]; e < grid.first[p + 1]; ++e)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          const int row = 3 * int(p) + i, column = 3 * int(grid.column[e]) + j;
          if (row >= column) entries.emplace_back(row, column, grid.values[e](i, j));
        }
  const Eigen::Index size = 3 * Eigen::Index(grid.rows());
  Tangent result(size, size);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

bool BlockMultigrid::Implementation::factorise(const Tangent& matrix, double shift) {
  factor.setShift(shift);
  factor.factorize(matrix);
  require_memory(factor.cholmod(), matrix.rows());
  return factor.info() == Eigen::Success;
}

void BlockMultigrid::Implementation::cycle(std::size_t level) {
  if (level + 1 == grids.size()) return solve_coarsest();
  BlockGrid &grid = grids[level], &coarse = grids[level + 1];
  sweep_forward(grid, team);
  restrict_residual(grid, coarse, team);
  cycle(level + 1);
  add_interpolated(coarse, grid, team);
  sweep_backward(grid, team);
}

void BlockMultigrid::Implementation::solve_coarsest() {
  BlockGrid& grid = grids.back();
  VectorXd load(3 * Eigen::Index(grid.rows()));
  for (std::size_t p = 0; p < grid.rows(); ++p)
    load.segment<3>(3 * Eigen::Index(p)) = grid.load[p].head<3>().cast<double>();
  const VectorXd solution = factor.solve(load);
  for (std::size_t p = 0; p < grid.rows(); ++p)
    grid.solution[p].head<3>() = solution.segment<3>(3 * Eigen::Index(p)).cast<float>().array();
}

BlockMultigrid::BlockMultigrid(const ElasticSystem& system, const Team& team)
    : implementation_(std::make_unique<Implementation>(system, team)) {}

BlockMultigrid::~BlockMultigrid() = default;

bool BlockMultigrid::set(const Tangent& matrix, double shift) {
  Implementation& own = *implementation_;
  if (own.grids.empty()) return own.factorise(matrix, shift);
  own.take_values(matrix, shift);
  for (std::size_t level = 0; level + 1 < own.grids.size(); ++level) {
    if (!prepare_sweeps(own.grids[level])) return false;
    restrict_matrix(own.grids[level], own.grids[level + 1]);
  }
  return own.factorise(own.lower_triangle(), 0.0);
}

VectorXd BlockMultigrid::solve(const VectorXd& load) {
  Implementation& own = *implementation_;
  if (own.grids.empty()) return own.factor.solve(load);
  BlockGrid& finest = own.grids.front();
  VectorXd result = VectorXd::Zero(load.size());
  const double scale = load.lpNorm<Eigen::Infinity>();  // beyond single precision's range
  if (!(scale > 0.0)) return result;
  for (std::size_t p = 0; p < own.row_of.size(); ++p)
    finest.load[own.row_of[p]].head<3>() =
        (load.segment<3>(3 * Eigen::Index(p)) / scale).cast<float>().array();
  own.cycle(0);
  for (std::size_t p = 0; p < own.row_of.size(); ++p)
    result.segment<3>(3 * Eigen::Index(p)) =
        scale * finest.solution[own.row_of[p]].head<3>().cast<double>().matrix();
  return result;
}

}  // namespace fingertip::lattice::inline statics
