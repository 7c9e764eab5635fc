/// Where the 3 x 3 blocks of a symmetric matrix lie in its compressed lower triangle.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace fingertip::lattice::inline statics {

/// The pattern of a symmetric sparse matrix of 3 x 3 blocks, one row and column of blocks per
/// particle, of which the lower triangle is stored column by column. Diagonal blocks always exist.
/// In a scalar column come first what the diagonal block has below (and on) the diagonal, then
/// three entries per further block.
class BlockPattern {
 public:
  /// Every two particles of a group share a block. Groups may repeat and hold repetitions.
  BlockPattern(std::size_t particles, const std::vector<std::vector<std::uint32_t>>& groups);

  /// A zero matrix.
  Eigen::SparseMatrix<double> empty() const;
  /// Number of the block of rows `p` in the columns of `q`, p > q; it must exist.
  std::uint32_t rank(std::uint32_t p, std::uint32_t q) const;
  /// Adds to the off-diagonal block of that rank in the columns of `q`.
  void add(std::uint32_t q, std::uint32_t rank, const Eigen::Matrix3d& block,
           double* values) const {
    for (int j = 0; j < 3; ++j) {
      double* entry = values + start_[3 * q + std::uint32_t(j)] + (3 - j) + 3 * rank;
      for (int i = 0; i < 3; ++i) entry[i] += block(i, j);
    }
  }
  /// Adds a symmetric block to the diagonal block of `q`.
  void add_diagonal(std::uint32_t q, const Eigen::Matrix3d& block, double* values) const {
    for (int j = 0; j < 3; ++j) {
      double* entry = values + start_[3 * q + std::uint32_t(j)];
      for (int i = j; i < 3; ++i) entry[i - j] += block(i, j);
    }
  }

 private:
  std::span<const std::uint32_t> below(std::uint32_t q) const {
    return {rows_.data() + first_[q], rows_.data() + first_[q + 1]};
  }

  std::vector<std::uint32_t> rows_;  ///< per column of blocks: its rows below the diagonal
  std::vector<std::size_t> first_;   ///< per column of blocks: where they begin in rows_
  std::vector<int> start_;           ///< per scalar column: its first entry
};

}  // namespace fingertip::lattice::inline statics
