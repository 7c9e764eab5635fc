/// Sparse Cholesky factor of a symmetric positive definite matrix, with the Schur complement of
/// its last unknowns at hand. Free of deal.II and of CHOLMOD's headers.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace fingertip::fem_reference::inline solvers {

/// Upper triangle of a symmetric matrix by columns, rows increasing.
struct UpperTriangle {
  std::vector<long> start;  ///< of every column, and the end
  std::vector<long> row;
  std::vector<double> value;
  long size() const { return long(start.size()) - 1; }
};

/// A = L L^T by CHOLMOD's supernodal method, ordered by nested dissection of groups of unknowns
/// (the nodes of a mesh), with the unknowns `last` behind all others. The pattern is analysed
/// once; matrices of the same pattern may follow.
class SparseFactor {
 public:
  /// `group[i]` names the group of unknown i. Throws NotConverged when ordering fails.
  SparseFactor(const UpperTriangle& pattern, const std::vector<long>& group,
               const std::vector<long>& last);
  ~SparseFactor();

  /// Throws NotConverged for a matrix that is not positive definite, or for want of memory.
  void factorise(const UpperTriangle& matrix);
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const { return solve_columns(b); }
  /// A^-1 b for each column of b at once.
  Eigen::MatrixXd solve_columns(const Eigen::MatrixXd& b) const;
  /// About as many solutions, one after the other, as take the time of one factorisation.
  double solves_per_factorisation() const;
  /// Block of the inverse that belongs to `last`: with L's last block L_c it is (L_c L_c^T)^-1.
  Eigen::MatrixXd last_block_of_inverse() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace fingertip::fem_reference::inline solvers
