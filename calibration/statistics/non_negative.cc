#include "calibration/statistics/non_negative.h"

#include <Eigen/QR>
#include <algorithm>
#include <vector>

#include "meshes/base/errors.h"

namespace fingertip::calibration::inline statistics {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Which unknowns are not held at 0.
using Free = std::vector<bool>;

/// Least squares in the columns that are free; the other unknowns are 0.
VectorXd solve_free(const MatrixXd& matrix, const VectorXd& right, const Free& free) {
  MatrixXd columns(matrix.rows(), std::count(free.begin(), free.end(), true));
  for (Index j = 0, k = 0; j < matrix.cols(); ++j)
    if (free[std::size_t(j)]) columns.col(k++) = matrix.col(j);
  const VectorXd solution = columns.householderQr().solve(right);
  VectorXd x = VectorXd::Zero(matrix.cols());
  for (Index j = 0, k = 0; j < matrix.cols(); ++j)
    if (free[std::size_t(j)]) x(j) = solution(k++);
  return x;
}

/// The unknown at 0 whose growth reduces the residual fastest; -1: none does, beyond round-off.
Index steepest(const MatrixXd& matrix, const VectorXd& residual, const Free& free, double noise) {
  Index best = -1;
  for (Index j = 0; j < matrix.cols(); ++j) {
    if (free[std::size_t(j)]) continue;
    const double gain = matrix.col(j).dot(residual);
    if (gain <= noise) continue;
    noise = gain;
    best = j;
  }
  return best;
}

/// Goes from x >= 0 towards the free least squares as far as possible; what reaches 0 on the way is
/// held there, until nothing is in the way.
VectorXd stride(const MatrixXd& matrix, const VectorXd& right, VectorXd x, Free& free) {
  for (;;) {
    VectorXd wanted = solve_free(matrix, right, free);
    double share = 1.0;
    Index first = -1;
    for (Index j = 0; j < x.size(); ++j) {
      if (!free[std::size_t(j)] || wanted(j) > 0.0) continue;
      const double reach = x(j) > 0.0 ? x(j) / (x(j) - wanted(j)) : 0.0;
      if (first >= 0 && reach >= share) continue;
      share = reach;
      first = j;
    }
    if (first < 0) return wanted;
    x = (x + share * (wanted - x)).cwiseMax(0.0);
    x(first) = 0.0;
    free[std::size_t(first)] = false;
  }
}

}  // namespace

VectorXd non_negative_least_squares(const MatrixXd& matrix, const VectorXd& right) {
  const double noise = 1e-13 * matrix.norm() * right.norm();
  VectorXd x = VectorXd::Zero(matrix.cols());
  Free free(std::size_t(matrix.cols()), false);
  for (Index changes = 0; changes < 10 * matrix.cols(); ++changes) {
    const Index next = steepest(matrix, right - matrix * x, free, noise);
    if (next < 0) return x;
    free[std::size_t(next)] = true;
    x = stride(matrix, right, x, free);
  }
  throw meshes::NotConverged("non-negative least squares: the active set does not converge");
}

}  // namespace fingertip::calibration::inline statistics
