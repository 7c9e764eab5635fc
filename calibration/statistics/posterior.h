/// The posterior of a fit whose values have errors of sizes that nobody has told.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "calibration/statistics/curve.h"
#include "calibration/statistics/fit_options.h"
#include "calibration/statistics/fit_result.h"
#include "calibration/statistics/forward_model.h"
#include "calibration/statistics/value_errors.h"

namespace fingertip::calibration::inline statistics {

/// A value far off all others, which counts for nothing.
struct OddValue {
  std::size_t curve = 0, place = 0;

  bool operator==(const OddValue&) const = default;
};

/// What is sought, with its priors, and the known errors of the models.
struct PosteriorInput {
  std::vector<Curve> curves;
  std::vector<ForwardModel*> models;  ///< one per curve
  CurveFitOptions options;
  Eigen::VectorXd deviations;  ///< LinearisedFit::deviations of all values
  bool noise_told = false;
  /// The first round has hardly any priors with heavy tails, so that the data choose which one is
  /// broken; else all hold at first.
  bool begins_open = true;
  /// No file resolves less, over the largest |value| [1].
  double least_told = 1e-5;
  /// Errors beside the noise, the misfit first, at estimates and computed values of all curves.
  std::function<std::vector<ErrorComponent>(const Eigen::VectorXd& estimates,
                                            const Eigen::VectorXd& computed)>
      components;
};

struct Posterior {
  std::vector<Curve> curves;  ///< of the input, sigma being their noise
  CurveFitOptions options;    ///< with the covariance of all other errors, by which they are fitted
  CurveFit fit;               ///< by these
  ValueErrors errors;
  std::vector<OddValue> odd;
};

/// Residuals and slopes at `estimates`, whose noise is not known.
LinearisedFit linearised(const std::vector<Curve>& curves, const std::vector<ForwardModel*>& models,
                         const std::vector<FreeParameter>& free, const Eigen::VectorXd& estimates);

/// In `free` a prior with heavy tails, as `told`, becomes the normal one that has the same slope at
/// the estimates; `open`: one that hardly holds.
void put_normal_priors(std::vector<FreeParameter>& free, const std::vector<FreeParameter>& told,
                       const Eigen::VectorXd& estimates, bool open = false);

/// From where `first` ended, again and again, twelve times at most, until estimates and odd values
/// stay; errors are those of value_errors, priors those of put_normal_priors. Values 4.5 deviations
/// off, everything else taken out, are odd unless they are more than one in 25; their noise becomes
/// what they are off by. Throws as fit_curves and value_errors do.
Posterior posterior_fit(const PosteriorInput& input, const CurveFit& first);

/// Covariance, standard errors and 95 % intervals of the posterior in place of those of `fit`. What
/// a prior keeps above a lower bound of 0 has an interval there, too, and is not at a bound.
void put_posterior(const ValueErrors& errors, const std::vector<FreeParameter>& free,
                   CurveFit& fit);

}  // namespace fingertip::calibration::inline statistics
