/// What a fit to curves seeks, from where and how.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "calibration/material/material_parameter.h"

namespace fingertip::calibration::inline statistics {

/// What is known of a parameter besides the curves, a normal distribution, in the parameter's unit.
struct Prior {
  double mean = 0.0;
  double deviation = 0.0;  ///< > 0
  /// Cauchy's, of what is usually small but, where it is not, of any size: posterior_fit alone
  /// knows them.
  bool heavy_tails = false;
};

/// E, G, bond, contact and times are positive and vary by their logarithm; k1, k2, k3 >= 0, kappa,
/// lambda and what is of a rig vary in units of `scale`. Bounds and start are in the parameter's
/// unit.
struct FreeParameter {
  MaterialParameter parameter = MaterialParameter::youngs_modulus;
  double start = 0.0;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  std::optional<Prior> prior = std::nullopt;
  double scale = 0.0;   ///< typical size; 0: |start|
  std::string of = {};  ///< the file or rig, where several have a parameter of this name
};

/// "touch_offset", or with its file or rig "touch_offset (second.csv)".
inline std::string label(const FreeParameter& free) {
  return std::string(name(free.parameter)) + (free.of.empty() ? "" : " (" + free.of + ")");
}

struct CurveFitOptions {
  std::vector<FreeParameter> free;
  /// Where sigma is not given, the deviation of a value [y] that priors are weighed against; 0:
  /// that which the residuals of the fit yield.
  double value_deviation = 0.0;
  /// Further vectors of start values: of all minima found, the least is reported.
  std::vector<Eigen::VectorXd> other_starts;
  /// Start values that are tried, one after the other, while the least of the minima is at a bound
  /// of Poisson's ratio and, where sigma is given, its chi-square is improbable.
  std::vector<Eigen::VectorXd> reserve_starts = {};
  /// The search begins at free's starts alone.
  void start_once() { other_starts.clear(), reserve_starts.clear(); }
  /// Width w in sigma of the loss w² (sqrt(1 + r²/w²) - 1), quadratic inside, linear outside; 0:
  /// least squares. Needs sigma.
  double robust_width = 0.0;
  /// Poisson's ratios between which E and G are sought where both are free and E has no bounds of
  /// its own: the ends of a table, 0 of law A. -1 < lowest < highest <= 1/2.
  double lowest_poissons_ratio = -0.999, highest_poissons_ratio = 0.5;
  /// Covariance of the models' own errors, which sigma does not contain, for all values of all
  /// curves in order [y²]: symmetric, positive semidefinite; empty: none. Where sigma is given the
  /// residuals are weighed by the sum of both covariances; else, the values' own deviation being
  /// unknown, all values count alike and the errors pass through the estimates.
  Eigen::MatrixXd model_covariance = {};
  int max_iterations = 50;  ///< per start, >= 1
  /// Evaluations of all models, from all starts together, each of which may use its share and what
  /// those before left of theirs, >= 1. A search that they do not suffice for ends with the least
  /// loss it has seen, not converged.
  int max_evaluations = std::numeric_limits<int>::max();
  /// The search ends where a step promises no more than this share of a standard error, in (0,
  /// 0.1]. Steps below it cost evaluations and tell nothing; on a kink of a model they creep.
  double tolerance = 1e-7;
  /// A direction counts as unidentifiable also when the curves' singular value is below this share
  /// of the largest, for errors of the model itself, which sigma does not contain, come through
  /// amplified by the inverse: at 0.02 an error of 2 %, the lattice's at R/6, may move the
  /// parameters by their own size.
  double relative_singular_value = 0.02;
  /// Models evaluated side by side, >= 1; the result does not depend on it.
  int threads = 1;
  /// Told after every evaluation of all models, in the calling thread, how many there were and the
  /// loss at this one; false ends the fit with Interrupted.
  std::function<bool(int evaluations, double loss)> progress = {};
};

/// Where the search starts.
inline Eigen::VectorXd start_of(const CurveFitOptions& options) {
  Eigen::VectorXd start(Eigen::Index(options.free.size()));
  for (Eigen::Index i = 0; i < start.size(); ++i) start(i) = options.free[std::size_t(i)].start;
  return start;
}

/// Of `options.free`, in that order.
inline std::vector<MaterialParameter> parameters_in(const CurveFitOptions& options) {
  std::vector<MaterialParameter> parameters;
  for (const FreeParameter& free : options.free) parameters.push_back(free.parameter);
  return parameters;
}

}  // namespace fingertip::calibration::inline statistics
