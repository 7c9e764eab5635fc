/// Cholesky factor of a principal submatrix whose index set changes a little from call to call.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fingertip::fem_reference::inline contact {

/// Factors A(I, I) of a symmetric positive definite A. Going from one index set to the next only
/// the rows behind the first dropped index are computed anew, O(n² k) for k new rows: contact
/// sets of a press grow by a few nodes per step.
class GrowingCholesky {
 public:
  /// Keeps a reference to `matrix`, which must outlive this object.
  explicit GrowingCholesky(const Eigen::MatrixXd& matrix);

  /// Factors the rows and columns with `chosen[i] != 0`. Throws NotConverged when the submatrix
  /// is not positive definite.
  void choose(const std::vector<char>& chosen);

  /// The chosen indices, in the order of `solve`.
  const std::vector<int>& indices() const { return indices_; }

  /// x with A(I, I) x = b.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

 private:
  void append(const std::vector<int>& added);

  const Eigen::MatrixXd& matrix_;
  Eigen::MatrixXd factor_;  ///< lower triangle of the leading block
  std::vector<int> indices_;
};

}  // namespace fingertip::fem_reference::inline contact
