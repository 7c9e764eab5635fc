/// What a fit to curves has found, and how sure it is.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "calibration/material/material_parameter.h"

namespace fingertip::calibration::inline statistics {

/// A change of all parameters together that the curves hardly see: a right singular vector.
struct Direction {
  Eigen::VectorXd changes;               ///< of the parameters over their size; largest component 1
  double relative_singular_value = 0.0;  ///< the curves' over their largest
  /// Half width of the 95 % interval of a step along `changes`, priors included; above 1 it exceeds
  /// the parameters.
  double interval = 0.0;
  std::string statement;
};

/// Where the search from one start ended.
struct Minimum {
  Eigen::VectorXd estimates;
  /// Half the sum of squares, in units of sigma or of the values' root mean square.
  double loss = 0.0;
  int iterations = 0;
  bool converged = true;  ///< false: the least loss seen when iterations or evaluations ran out
};

/// Everything local is linearised at the estimates.
struct CurveFit {
  std::vector<MaterialParameter> parameters;
  std::vector<std::string> labels;  ///< theirs, for people
  Eigen::VectorXd estimates;
  /// sigma given: (Jᵀ J)⁻¹ with J whitened by sigma and model_covariance, priors as further rows;
  /// not given: with the residuals' own deviation, and what model_covariance makes of the
  /// estimates. With a robust loss J is weighted by the loss's slope.
  Eigen::MatrixXd covariance, correlation;
  Eigen::VectorXd standard_errors;
  /// 95 % intervals: normal where sigma is given, times birge_ratio, else Student's t.
  Eigen::VectorXd lower, upper;
  /// Its interval then is not one. Of E also where Poisson's ratio is at its bound.
  std::vector<bool> at_bound;
  /// Standard error of Poisson's ratio where E and G are sought, to first order.
  std::optional<double> poissons_ratio_error;
  /// Where E and G are sought and Poisson's ratio has ended at a bound: that bound.
  std::optional<double> poissons_ratio_bound;
  int degrees_of_freedom = 0;  ///< values and priors minus parameters
  /// Sum of squares in units of sigma (and of the priors' deviations), and the probability of at
  /// least that if model and sigma are right; only where sigma is given and the loss is quadratic.
  std::optional<double> chi_square, chi_square_probability;
  /// Birge's ratio, sqrt(chi_square/degrees_of_freedom), where chi_square is improbable (below
  /// 0.01): the residuals are so many times larger than sigma explains, and the intervals, not the
  /// covariance, are widened by it (Birge, Phys. Rev. 40, 207, 1932). Else 1.
  double birge_ratio = 1.0;
  double residual_deviation = 0.0;  ///< sqrt(sum of squares / degrees of freedom), data only [y]
  /// J: derivatives of the curves' values, curve by curve, times `whitening` [1 per unit]. Priors
  /// are not among its rows.
  Eigen::MatrixXd jacobian;
  /// What residuals are multiplied by [1/y], symmetric: the inverse root of the covariance of
  /// sigma (or of what the residuals yield for it) and of the models' errors. With a robust loss
  /// its rows are smaller where the loss gives a value less weight.
  Eigen::MatrixXd whitening;
  /// d(estimates)/d(y), a row per parameter, a column per value of every curve in order [unit of
  /// the parameter per unit of y]: (JᵀJ + priors)⁻¹ Jᵀ whitening at the estimates; bounds do not
  /// count. Data that contain d, which the model does not, move the estimates by this times d.
  Eigen::MatrixXd influence;
  /// Of `jacobian` times the parameters' sizes, decreasing.
  Eigen::VectorXd singular_values;
  std::vector<Direction> unidentifiable;
  /// What the curves leave open and priors close: they say more about it than the curves, and the
  /// interval does not exceed the parameters.
  std::vector<Direction> only_from_priors;
  std::vector<Eigen::VectorXd> residuals;  ///< measured minus computed, per curve [y]
  /// The same over sigma, or times the inverse root of the covariance of sigma and of the models'
  /// errors, whatever the loss: chi_square is the sum of their squares and of the priors'. Empty
  /// without sigma.
  std::vector<Eigen::VectorXd> whitened_residuals;
  bool converged = true;        ///< the least of all minima is one
  int iterations = 0;           ///< of the start reported
  int evaluations = 0;          ///< of all models, from all starts
  std::vector<Minimum> minima;  ///< from every start, in order
};

}  // namespace fingertip::calibration::inline statistics
