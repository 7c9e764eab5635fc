#include "meshes/base/dense.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace fingertip::meshes::inline base {

using Eigen::MatrixXd;

MatrixXd EigenPairs::root() const {
  return vectors * values.cwiseSqrt().asDiagonal() * vectors.transpose();
}

MatrixXd EigenPairs::inverse_root() const {
  return vectors * values.cwiseSqrt().cwiseInverse().asDiagonal() * vectors.transpose();
}

EigenPairs symmetric_eigen(const MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

SingularValues singular_values(const MatrixXd& matrix) {
  const Eigen::JacobiSVD<MatrixXd> svd(matrix, Eigen::ComputeFullV);
  return {svd.singularValues(), svd.matrixV()};
}

MatrixXd least_squares(const MatrixXd& columns, const MatrixXd& right) {
  return columns.colPivHouseholderQr().solve(right);
}

MatrixXd shortest_least_squares(const MatrixXd& columns, const MatrixXd& right, double dependent) {
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> decomposition;
  if (dependent > 0.0) decomposition.setThreshold(dependent);
  return decomposition.compute(columns).solve(right);
}

MatrixXd pseudo_inverse(const MatrixXd& matrix) {
  return matrix.completeOrthogonalDecomposition().pseudoInverse();
}

OrthonormalBasis orthonormal_basis(const MatrixXd& columns, double dependent) {
  Eigen::ColPivHouseholderQR<MatrixXd> qr(columns);
  qr.setThreshold(dependent);
  return {qr.householderQ() * MatrixXd::Identity(columns.rows(), columns.rows()), qr.rank()};
}

}  // namespace fingertip::meshes::inline base
