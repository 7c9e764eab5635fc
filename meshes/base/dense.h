/// Decompositions of dense matrices of any size. Each costs the compiler seconds wherever Eigen's
/// template is used; here all of them are compiled once.
#pragma once

#include <Eigen/Core>

namespace fingertip::meshes::inline base {

/// Of a symmetric matrix, of which the lower half is read: values increase, vectors are columns of
/// length 1.
struct EigenPairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;

  /// Of a positive matrix A: A^1/2 and A^-1/2, symmetric.
  Eigen::MatrixXd root() const;
  Eigen::MatrixXd inverse_root() const;
};
EigenPairs symmetric_eigen(const Eigen::MatrixXd& matrix);

/// Of A = U S Vᵀ: S, decreasing, as many as the fewer of rows and columns; V, square.
struct SingularValues {
  Eigen::VectorXd values;
  Eigen::MatrixXd right;
};
SingularValues singular_values(const Eigen::MatrixXd& matrix);

/// The X of least |columns X - right|, by QR with pivots of the columns, which should be
/// independent.
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& right);

/// The shortest of them where columns depend on each other: pivots below `dependent` of the largest
/// count as zero. 0: below round-off.
Eigen::MatrixXd shortest_least_squares(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& right,
                                       double dependent = 0.0);

/// Of Moore and Penrose.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& matrix);

/// Orthonormal columns: the first `rank` span those of a matrix, the others what is orthogonal to
/// them.
struct OrthonormalBasis {
  Eigen::MatrixXd columns;
  Eigen::Index rank = 0;
};
OrthonormalBasis orthonormal_basis(const Eigen::MatrixXd& columns, double dependent);

}  // namespace fingertip::meshes::inline base
