/// Material parameters from force-indentation curves, with what the data can and cannot say.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "calibration/forward_model.h"
#include "lattice/settings.h"

namespace fingertip::calibration {

/// A measured press.
struct Curve {
  std::vector<double> indentation;  ///< [m], positive, increasing
  std::vector<double> force;        ///< along the plane's normal [N]
  /// Standard deviation of every force [N], > 0; empty where unknown, in all curves or in none:
  /// then every force of every curve counts as equally uncertain.
  std::vector<double> sigma;
  /// How it was pressed and by what lattice it is computed; depth and samples are the curve's,
  /// `lateral` shrinks with the depth.
  lattice::PressSetup condition;
};

/// What is known of a parameter besides the curves, a normal distribution, in the parameter's unit.
struct Prior {
  double mean = 0.0;
  double deviation = 0.0;  ///< > 0
};

/// E, G, bond and contact are positive and vary by their logarithm; k1, k2, k3 >= 0, kappa and
/// lambda vary in units of `scale`. Bounds and start are in the parameter's unit.
struct FreeParameter {
  MaterialParameter parameter = MaterialParameter::youngs_modulus;
  double start = 0.0;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  std::optional<Prior> prior = std::nullopt;  ///< only where sigma is given, to weigh it against
  double scale = 0.0;                         ///< typical size; 0: |start|
};

struct PressFitOptions {
  std::vector<FreeParameter> free;
  /// Further vectors of start values: of all minima found, the least is reported.
  std::vector<Eigen::VectorXd> other_starts;
  /// Width w in sigma of the loss w² (sqrt(1 + r²/w²) - 1), quadratic inside, linear outside; 0:
  /// least squares. Needs sigma.
  double robust_width = 0.0;
  int max_iterations = 50;  ///< per start, >= 1
  /// A direction counts as unidentifiable also when the curves' singular value is below this share
  /// of the largest, for errors of the model itself, which sigma does not contain, come through
  /// amplified by the inverse: at 0.02 an error of 2 %, the lattice's at R/6, may move the
  /// parameters by their own size.
  double relative_singular_value = 0.02;
};

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
  double loss =
      0.0;  ///< half the sum of squares, in units of sigma or of the forces' root mean square
  int iterations = 0;
};

/// Everything local is linearised at the estimates.
struct PressFit {
  std::vector<MaterialParameter> parameters;
  Eigen::VectorXd estimates;
  /// sigma given: (Jᵀ J)⁻¹ with J in units of sigma, priors as further rows; not given: times the
  /// residual variance. With a robust loss J is weighted by the loss's slope.
  Eigen::MatrixXd covariance, correlation;
  Eigen::VectorXd standard_errors;
  /// 95 % intervals: normal where sigma is given, else Student's t.
  Eigen::VectorXd lower, upper;
  std::vector<bool> at_bound;  ///< its interval then is not one
  int degrees_of_freedom = 0;  ///< forces and priors minus parameters
  /// Sum of squares in units of sigma (and of the priors' deviations), and the probability of at
  /// least that if model and sigma are right; only where sigma is given and the loss is quadratic.
  std::optional<double> chi_square, chi_square_probability;
  double residual_deviation = 0.0;  ///< sqrt(sum of squares / degrees of freedom), data only [N]
  /// Of the curves' rows of J times the parameters' sizes, in units of sigma (or of
  /// `residual_deviation`), decreasing.
  Eigen::VectorXd singular_values;
  std::vector<Direction> unidentifiable;
  /// What the curves leave open and priors close: they say more about it than the curves, and the
  /// interval does not exceed the parameters.
  std::vector<Direction> only_from_priors;
  std::vector<Eigen::VectorXd> residuals;  ///< measured minus computed, per curve [N]
  int iterations = 0;                      ///< of the start reported
  std::vector<Minimum> minima;             ///< from every start, in order
};

/// Least squares by Ceres with the model's own Jacobian. Throws InvalidInput for an empty curve,
/// lists of different length, indentations that are not positive and increasing, values that are
/// not finite, sigma that is not positive, a prior or robust loss without sigma, a start outside
/// its bounds, fewer forces than parameters, constants of springs at different spacings, and for
/// what the press refuses at the start; NotConverged when max_iterations do not suffice.
PressFit fit_press(const std::vector<Curve>& curves, const PressFitOptions& options);

/// The same with a model per curve, whose parameters are `options.free` in that order; conditions
/// do not matter.
PressFit fit_models(const std::vector<Curve>& curves, const std::vector<ForwardModel*>& models,
                    const PressFitOptions& options);

}  // namespace fingertip::calibration
