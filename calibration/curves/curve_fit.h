/// Material parameters from measured curves, with what the data can and cannot say.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "calibration/curves/curve.h"
#include "calibration/curves/forward_model.h"
#include "lattice/press/press_setup.h"

namespace fingertip::calibration {

/// What is known of a parameter besides the curves, a normal distribution, in the parameter's unit.
struct Prior {
  double mean = 0.0;
  double deviation = 0.0;  ///< > 0
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
std::string label(const FreeParameter& free);

struct CurveFitOptions {
  std::vector<FreeParameter> free;
  /// Without sigma, errors of successive values may follow each other: CurveFit::order_ratio.
  bool serial = false;
  /// Where sigma is not given, the deviation of a value [y] that priors are weighed against; 0:
  /// that which the residuals of the fit yield.
  double value_deviation = 0.0;
  /// Further vectors of start values: of all minima found, the least is reported.
  std::vector<Eigen::VectorXd> other_starts;
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
  /// Where options.serial and residuals have an order: the root of the degrees of freedom over
  /// those of as many independent values as an autoregression of that correlation is worth.
  /// Covariance and intervals are as much wider, and Student's t is theirs, but for what
  /// model_covariance makes of the estimates, in which such errors are known. Else 1.
  double order_ratio = 1.0;
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

/// Least squares by Ceres with the models' own Jacobians; a model per curve, whose parameters are
/// `options.free` in that order. Throws InvalidInput for an empty curve, lists of different length,
/// abscissae that are not positive and increasing, values that are not finite, sigma that is not
/// positive, a robust loss without sigma, a start outside its bounds, fewer values than
/// parameters, and for what a model refuses at the first start; NotConverged where it has no answer
/// there; Interrupted. Iterations or evaluations that do not suffice are told by `converged`.
CurveFit fit_curves(const std::vector<Curve>& curves, const std::vector<ForwardModel*>& models,
                    const CurveFitOptions& options);

/// The same for presses of the static lattice, a condition per curve: how it was pressed and by
/// what lattice it is computed; depth and samples are the curve's, `lateral` shrinks with the
/// depth. `go_on` is asked while a press runs, from options.threads threads; false ends the fit
/// with Interrupted. Throws InvalidInput also for constants of springs at different spacings.
CurveFit fit_presses(const std::vector<Curve>& curves,
                     const std::vector<lattice::PressSetup>& conditions,
                     const CurveFitOptions& options, const std::function<bool()>& go_on = {});

}  // namespace fingertip::calibration
