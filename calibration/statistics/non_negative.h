/// Linear least squares with unknowns that must not be negative.
#pragma once

#include <Eigen/Core>

namespace fingertip::calibration::inline statistics {

/// x >= 0 of least |matrix x - right|, by the active-set method of Lawson & Hanson (Solving Least
/// Squares Problems, 1974, ch. 23): finite, and exact but for round-off. The columns of `matrix`
/// must be linearly independent. Throws NotConverged after 10 changes of the active set per
/// unknown, which round-off alone can cause.
Eigen::VectorXd non_negative_least_squares(const Eigen::MatrixXd& matrix,
                                           const Eigen::VectorXd& right);

}  // namespace fingertip::calibration::inline statistics
