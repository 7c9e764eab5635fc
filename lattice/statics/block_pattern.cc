#include "lattice/statics/block_pattern.h"

#include <algorithm>

namespace fingertip::lattice::inline statics {

BlockPattern::BlockPattern(std::size_t particles,
                           const std::vector<std::vector<std::uint32_t>>& groups) {
  std::vector<std::vector<std::uint32_t>> columns(particles);
  for (const auto& group : groups)
    for (const std::uint32_t q : group)
      for (const std::uint32_t p : group)
        if (p > q) columns[q].push_back(p);
  first_.push_back(0);
  start_.push_back(0);
  for (auto& column : columns) {
    std::ranges::sort(column);
    column.erase(std::unique(column.begin(), column.end()), column.end());
    rows_.insert(rows_.end(), column.begin(), column.end());
    first_.push_back(rows_.size());
    for (int j = 0; j < 3; ++j) start_.push_back(start_.back() + 3 - j + 3 * int(column.size()));
  }
}

Eigen::SparseMatrix<double> BlockPattern::empty() const {
  const Eigen::Index size = Eigen::Index(start_.size()) - 1;
  Eigen::SparseMatrix<double> result(size, size);
  result.resizeNonZeros(start_.back());
  std::ranges::copy(start_, result.outerIndexPtr());
  std::fill_n(result.valuePtr(), result.nonZeros(), 0.0);
  int* row = result.innerIndexPtr();
  for (std::uint32_t q = 0; 3 * q < std::uint32_t(size); ++q) {
    for (std::uint32_t j = 0; j < 3; ++j) {
      for (std::uint32_t i = j; i < 3; ++i) *row++ = int(3 * q + i);
      for (const std::uint32_t p : below(q))
        for (std::uint32_t i = 0; i < 3; ++i) *row++ = int(3 * p + i);
    }
  }
  return result;
}

std::uint32_t BlockPattern::rank(std::uint32_t p, std::uint32_t q) const {
  const auto rows = below(q);
  return std::uint32_t(std::ranges::lower_bound(rows, p) - rows.begin());
}

}  // namespace fingertip::lattice::inline statics
