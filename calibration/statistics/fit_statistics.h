/// What the Jacobian at a least-squares fit says about its parameters.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "calibration/statistics/fit_result.h"

namespace fingertip::calibration::inline statistics {

/// Half width of the 95 % interval over the standard error: Student's t, and 1.96 for a normal
/// distribution. `degrees_of_freedom` > 0.
double student_95(double degrees_of_freedom);
double normal_95();

/// Below which a mixture of normal distributions has `share`; the three lists have an entry per
/// distribution, weights of sum 1.
double mixture_point(const std::vector<double>& means, const std::vector<double>& deviations,
                     const std::vector<double>& weights, double share);

/// Probability that chi-square with so many degrees of freedom (>= 1) is at least that large.
double chi_square_above(double chi_square, int degrees_of_freedom);

/// Singular value decomposition of a Jacobian whose columns are parameters over their sizes and
/// whose rows are residuals over their deviations.
class Sensitivity {
 public:
  /// `jacobian` of residuals over deviations by the parameters themselves, `sizes` > 0.
  Sensitivity(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& sizes);

  /// Decreasing, one per parameter, zero where there are fewer residuals.
  const Eigen::VectorXd& singular_values() const { return values_; }
  /// Right singular vectors as columns, in units of the sizes.
  const Eigen::MatrixXd& directions() const { return directions_; }
  /// Of the parameters themselves. Singular values count as at least 1e-15 of the largest, so that
  /// what is not seen at all has a huge variance, not an infinite one.
  Eigen::MatrixXd covariance() const;

 private:
  Eigen::VectorXd sizes_, values_;
  Eigen::MatrixXd directions_;
};

/// What AICc adds to -2 log-likelihood of `n` values by `k` parameters, the noise's deviation among
/// them: 2k + 2k(k + 1)/(n - k - 1) (Hurvich & Tsai, Biometrika 76, 297, 1989), of linear least
/// squares by how much likelier, in the mean, the fitted values are than new ones. Infinite where
/// n <= k + 1.
double aicc_penalty(double n, double k);

/// A half width of the 95 % interval of Poisson's ratio beyond which E and G count as not told
/// apart: half of +-1/4, which holds for every rubber (0 to 1/2) before anything is measured.
inline constexpr double open_ratio = 0.125;

/// d nu/d(parameters) where E and G are both sought, nu = E/(2G) - 1; else none.
std::optional<Eigen::VectorXd> ratio_slopes(const CurveFit& fit);

/// Fills in singular values, unidentifiable and only_from_priors of `fit`, whose parameters,
/// labels, estimates, jacobian and covariance are known. `priors` are the priors' rows over their
/// deviations; `quantile` is the 95 % interval's half width over a standard error. A direction is
/// open where the curves' singular value is below `threshold` times the largest, where their own
/// interval along it exceeds the sizes, and where it is the one that leaves Poisson's ratio open.
void describe_sensitivity(CurveFit& fit, const Eigen::MatrixXd& priors,
                          const Eigen::VectorXd& sizes, double threshold, double quantile);

}  // namespace fingertip::calibration::inline statistics
