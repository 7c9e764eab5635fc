#include "fem_reference/contact/growing_cholesky.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "meshes/base/errors.h"

namespace fingertip::fem_reference::inline contact {

GrowingCholesky::GrowingCholesky(const Eigen::MatrixXd& matrix)
    : matrix_(matrix), factor_(matrix.rows(), matrix.cols()) {}

void GrowingCholesky::choose(const std::vector<char>& chosen) {
  const auto dropped =
      std::ranges::find_if(indices_, [&](int i) { return !chosen[std::size_t(i)]; });
  indices_.erase(dropped, indices_.end());
  std::vector<char> present(chosen.size(), 0);
  for (const int i : indices_) present[std::size_t(i)] = 1;
  std::vector<int> added;
  for (std::size_t i = 0; i < chosen.size(); ++i)
    if (chosen[i] && !present[i]) added.push_back(int(i));
  if (!added.empty()) append(added);
}

void GrowingCholesky::append(const std::vector<int>& added) {
  const auto old = Eigen::Index(indices_.size()), fresh = Eigen::Index(added.size());
  Eigen::MatrixXd corner = matrix_(added, added);
  if (old > 0) {  // Eigen 3.4 divides by zero in products of inner dimension zero
    auto rows = factor_.block(old, 0, fresh, old);
    rows = matrix_(added, indices_);
    const auto lower = factor_.topLeftCorner(old, old).triangularView<Eigen::Lower>();
    lower.transpose().solveInPlace<Eigen::OnTheRight>(rows);
    corner.selfadjointView<Eigen::Lower>().rankUpdate(rows, -1.0);
  }
  const Eigen::LLT<Eigen::MatrixXd> llt(corner);
  if (llt.info() != Eigen::Success)
    throw meshes::NotConverged("the contact stiffness is not positive definite");
  factor_.block(old, old, fresh, fresh) = llt.matrixL();
  indices_.insert(indices_.end(), added.begin(), added.end());
}

Eigen::VectorXd GrowingCholesky::solve(const Eigen::VectorXd& b) const {
  const auto n = Eigen::Index(indices_.size());
  const auto lower = factor_.topLeftCorner(n, n).triangularView<Eigen::Lower>();
  return lower.transpose().solve(lower.solve(b));
}

}  // namespace fingertip::fem_reference::inline contact
