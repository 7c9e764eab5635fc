/// What presses that are not made yet would tell of parameters.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "calibration/files/fit_file.h"
#include "calibration/statistics/fit_options.h"

namespace fingertip::calibration::inline statistics {

/// Values that are measured or planned, linearised.
struct Observations {
  Eigen::MatrixXd jacobian;          ///< d(value)/d(parameter), a row per value [y per unit]
  Eigen::VectorXd deviation;         ///< of every value, > 0 [y]
  Eigen::MatrixXd model_covariance;  ///< of the models' own errors [y²]; empty: none
};

/// (Jᵀ (S + M)⁻¹ J + P)⁻¹ with S the squares of the deviations, M the model's covariance and P what
/// the priors of `free`, one per column of J, add: the covariance that Gauss and Newton's step
/// expects of a fit to such values. Directions that nothing tells have huge variances. Throws
/// InvalidInput for sizes that do not fit, deviations that are not positive and a matrix M that is
/// no covariance.
Eigen::MatrixXd predicted_covariance(const Observations& observations,
                                     const std::vector<FreeParameter>& free);

/// Two parameters of which data know a combination only.
struct CollinearPair {
  std::size_t first = 0, second = 0;
  double correlation = 0.0;
  double times = 1.0;  ///< so many times narrower one's interval is where the other is known
};

/// Intervals so many times wider than with the other parameter known are told.
inline constexpr double much_wider = 3.0;

/// Pairs with 1/sqrt(1 - correlation²) >= much_wider, the worst first.
std::vector<CollinearPair> nearly_collinear(const Eigen::MatrixXd& covariance);

/// A measurement that is not made yet, beside those that are.
struct MeasurementGain {
  std::string name;       ///< "ball"
  std::string press;      ///< for people: contact, obstacle, depth, number of values
  Eigen::VectorXd times;  ///< per parameter: so many times narrower its interval would be, >= 1
  std::string failure;    ///< why nothing is known of it; `times` is empty then
};

/// Best first: by the geometric mean of `times` of the first `decisive` parameters, what failed
/// last.
void sort_by_gain(std::vector<MeasurementGain>& gains, std::size_t decisive);

/// As entries of a file: the 95 % intervals, now from `lower` to `upper` about `at`, after each.
std::vector<NextEntry> next_entries(const std::vector<MeasurementGain>& gains,
                                    const std::vector<std::string>& labels,
                                    const Eigen::VectorXd& at, const Eigen::VectorXd& lower,
                                    const Eigen::VectorXd& upper);

/// A sentence on the best one, for the `labels` of the parameters; empty where there is none.
std::string gain_statement(const std::vector<MeasurementGain>& sorted,
                           const std::vector<std::string>& labels, std::size_t decisive);

}  // namespace fingertip::calibration::inline statistics
