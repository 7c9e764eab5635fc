/// Errors of values whose size nobody has told: noise, a smooth part that the model misses, a
/// factor on every repeat. How large they are, and what that leaves of the parameters.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibration/statistics/fit_options.h"

namespace fingertip::calibration::inline statistics {

/// The values are off by `columns` times numbers of mean 0 and one unknown deviation, whose own
/// prior is half of Cauchy's distribution (Gelman, Bayesian Analysis 1, 515, 2006).
struct ErrorComponent {
  Eigen::MatrixXd columns;  ///< a row per value [y]
  double scale = 0.01;      ///< of the deviation's prior, > 0
  bool known = false;       ///< the deviation is 1
};

/// A fit linearised at its estimates, and what is known of its values' errors.
struct LinearisedFit {
  Eigen::VectorXd residuals;         ///< measured minus computed [y]
  Eigen::MatrixXd jacobian;          ///< of the computed values [y per unit of the parameter]
  Eigen::VectorXd estimates;         ///< of the parameters
  std::vector<FreeParameter> free;   ///< theirs, whose priors count
  Eigen::VectorXd deviations;        ///< of the noise, > 0 [y]: told, or alike up to a factor
  bool noise_told = false;           ///< then within a factor of two or so
  double least_noise = 0.0;          ///< over the deviations: no file resolves less
  Eigen::MatrixXd model_covariance;  ///< of known errors of the models [y²]; empty: none
};

/// One posterior of parameters, errors and their sizes.
struct ValueErrors {
  double noise = 1.0;  ///< factor on the deviations, median
  /// Per component: median of its deviation, its 95 % point, and the expected part of the residuals
  /// [y].
  std::vector<double> sizes, upper_sizes;
  std::vector<Eigen::VectorXd> parts;
  /// Twice the logarithm of how many times likelier the residuals are with the component at its
  /// best size than without: 6 and more is seen in the data.
  std::vector<double> seen;
  Eigen::MatrixXd covariance_of_values;  ///< of all but the noise, at these sizes [y²]
  Eigen::VectorXd mean, lower, upper;    ///< of the parameters, 95 %
  Eigen::MatrixXd covariance;            ///< of the parameters
  /// Of the data, between models of the same parameters.
  double log_evidence = 0.0;
  /// With the parameters at their best, those with a prior integrated out, and the sizes likeliest
  /// by the restricted likelihood: between models of other parameters.
  double log_likelihood = 0.0;
};

/// Given the sizes, everything is linear and normal, errors of components beside parameters
/// (Henderson's mixed-model equations); the sizes have the restricted likelihood that is left when
/// both are integrated out (Patterson & Thompson, Biometrika 58, 545, 1971) and are summed over on
/// a grid, so that few values or repeats widen the intervals as they ought to. Bounds do not count.
/// Throws InvalidInput for sizes that do not fit and deviations that are not positive.
ValueErrors value_errors(const LinearisedFit& fit, const std::vector<ErrorComponent>& components);

/// Values that a fit has not seen, linearised at its estimates.
struct FurtherValues {
  Eigen::MatrixXd jacobian;              ///< by the parameters of the fit [y per unit]
  std::vector<Eigen::MatrixXd> columns;  ///< those of the components, by whose numbers they are off
  Eigen::VectorXd deviations;            ///< of their noise, as that of the fit's values
};

/// So many draws of what further values are, less those computed at the estimates: of parameters
/// and components as the fit leaves them, of their sizes and of noise, always the same. A row per
/// value, a column per draw. Throws as value_errors does.
Eigen::MatrixXd further_values(const LinearisedFit& fit,
                               const std::vector<ErrorComponent>& components,
                               const FurtherValues& further, Eigen::Index draws);

/// Columns of a smooth function of `u`, of deviation 1 everywhere and correlated over about
/// `length` of u: a row per entry of u, in [0, 1].
Eigen::MatrixXd smooth_columns(const Eigen::VectorXd& u, double length);

}  // namespace fingertip::calibration::inline statistics
