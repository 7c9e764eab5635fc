/// A grid of 3 x 3 blocks, and what a multigrid does with it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lattice/statics/lattice_body.h"
#include "lattice/threads/parallel.h"

namespace fingertip::lattice::inline statics {

/// x, y, z and what means nothing, in one register.
using Four = Eigen::Array4f;

/// 3 x 3 blocks in single precision, column by column: a sweep is as fast as memory brings them.
class Blocks {
 public:
  void resize(std::size_t count) { values_.resize(9 * count + 1); }
  void set(std::size_t n, const Eigen::Matrix3d& block) {
    Eigen::Map<Eigen::Matrix3f>(values_.data() + 9 * n) = block.cast<float>();
  }
  /// A column is read with the number behind it.
  [[gnu::always_inline]] Four product(std::size_t n, const Four& x) const {
    using Column = Eigen::Map<const Four>;
    const float* block = values_.data() + 9 * n;
    return Column(block) * x[0] + Column(block + 3) * x[1] + Column(block + 6) * x[2];
  }

 private:
  std::vector<float> values_;
};

/// 0 to 7: which of a place's coordinates are odd.
inline int parity(const GridPlace& place) {
  return (place[0] & 1) + 2 * (place[1] & 1) + 4 * (place[2] & 1);
}

/// The 27 places around one, itself included, have ranks.
inline constexpr std::size_t ranks = 27;

/// A grid's points as rows of blocks, in the order of the sweeps: by parity, so that no two rows of
/// a parity share a block.
struct BlockGrid {
  std::vector<GridPlace> places;
  /// Of every row its blocks: that on the diagonal, those of earlier rows, from `later` on those of
  /// later rows.
  std::vector<std::uint32_t> first, later, column;
  std::vector<Eigen::Matrix3d> values;  ///< per block
  Blocks blocks, inverse;               ///< the same; inverses of those on the diagonal
  /// Of every row the rows of the coarser grid from which it is interpolated with equal weights.
  std::vector<std::uint32_t> first_parent, parent;
  /// Per row and rank: the block; on coarser grids.
  std::vector<std::array<std::uint32_t, ranks>> block_at;
  std::vector<Four> load, solution, free;  ///< free: 0 where a component is held, else 1
  std::vector<Four> share;                 ///< of the residual, for each parent
  /// Before which row a parity's rows begin.
  std::array<std::uint32_t, 9> begins{};

  std::size_t rows() const { return places.size(); }
  std::span<const std::uint32_t> parents(std::size_t row) const {
    return {parent.data() + first_parent[row], parent.data() + first_parent[row + 1]};
  }
};

/// Values and fields for the grid's pattern: zero, and nothing held.
void size_fields(BlockGrid& grid);
/// The grid of the even places; sets the parents of `fine`.
BlockGrid coarsened(BlockGrid& fine);
/// Galerkin's matrix: what the fine one costs of displacements that the coarser grid has. Sets
/// `free`, too: a coarse component that moves nothing but what is held, is held.
void restrict_matrix(const BlockGrid& fine, BlockGrid& coarse);
/// From `values` to `blocks` and `inverse`; false where a block on the diagonal is not positive
/// definite.
bool prepare_sweeps(BlockGrid& grid);
/// Gauss-Seidel's sweep from a solution of 0: later rows have no share yet.
void sweep_forward(BlockGrid& grid, Team& team);
/// The residual after sweep_forward, which is what later rows have.
void restrict_residual(BlockGrid& grid, BlockGrid& coarse, Team& team);
void add_interpolated(const BlockGrid& coarse, BlockGrid& grid, Team& team);
void sweep_backward(BlockGrid& grid, Team& team);

}  // namespace fingertip::lattice::inline statics
