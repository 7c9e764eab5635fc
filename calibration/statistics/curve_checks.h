/// What stands against a fit: data left out, the true shape of its valley, errors of the model.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/statistics/curve_fit.h"
#include "calibration/statistics/residual_structure.h"

namespace fingertip::calibration::inline statistics {

/// A fit to all curves but one, and what it predicts of that one.
struct LeftOut {
  Eigen::VectorXd estimates;
  Eigen::VectorXd residuals;  ///< of the curve left out, measured minus predicted [y]
  double worst_relative_error = 0.0;
  std::string failure;  ///< why there is no such fit; all else is then empty
};

/// Largest |residual| over |measured| where that is not zero; of a travel over its largest
/// |measured|. `residuals` has an entry per value of `curve`.
double worst_relative_error(const Eigen::VectorXd& residuals, const Curve& curve);

/// Root mean square of residuals over that of `values`, as many as there are; NaN where all are
/// zero. The one meaning of "root mean square" in what is told of fits to curves.
double relative_rms(const Eigen::VectorXd& residuals, const Eigen::VectorXd& values);
inline constexpr std::string_view name_of_relative_rms =
    "root mean square of the residuals over that of the data";

/// A sentence where relative_rms of `name` is more than `most`, which no noise explains: `model`,
/// "the model" or "the law", does not describe it.
std::optional<std::string> missed(const std::string& model, const std::string& name,
                                  const Eigen::VectorXd& residuals, const Eigen::VectorXd& values,
                                  double most);

/// One per curve, each sought from `fit`'s estimates alone. Throws InvalidInput for less than two
/// curves, Interrupted.
std::vector<LeftOut> leave_one_out(const std::vector<Curve>& curves,
                                   const std::vector<ForwardModel*>& models,
                                   const CurveFitOptions& options, const CurveFit& fit);

/// Chi-square over two parameters, least over all others.
struct Profile {
  /// Ascending, evenly spaced around the estimate; cut off at bounds, and at a tenth of the
  /// estimate of what is positive by nature [the parameter's unit].
  Eigen::VectorXd first_values, second_values;
  /// Over its value at the estimates, rows first, columns second; in units of sigma or of the
  /// residual deviation, with priors; of a robust loss twice the loss. NaN where a model has no
  /// answer. The joint 95 % region of two parameters is where it is below 5.99 (sigma known).
  Eigen::MatrixXd increase;
};

/// `first` and `second` are places in options.free; the grid has `points` >= 2 per parameter, to
/// three standard errors on both sides. At every point the two are held and the others sought,
/// starting where the fit's covariance expects them. Throws InvalidInput for places that are not
/// two different ones; Interrupted.
Profile profile_likelihood(const std::vector<Curve>& curves,
                           const std::vector<ForwardModel*>& models, const CurveFitOptions& options,
                           const CurveFit& fit, std::size_t first, std::size_t second,
                           int points = 9);

/// The values of one parameter between which chi-square, least over all others, rises by less than
/// the square of `half_width`, in units of sigma or of the residual deviation: of a quadratic loss
/// estimate +- half_width standard errors. Without sigma the models' errors, which then are no part
/// of chi-square, widen both sides as independent ones (hypot). NaN at a side where it does not
/// rise that much within the parameter's bounds or 30 standard errors, or where a model has no
/// answer.
struct ProfileInterval {
  double lower = 0.0, upper = 0.0;
};

/// `place` in options.free; `half_width` > 0, 1.96 for 95 % of a normal distribution. The others
/// are sought from where the covariance expects them; ends are found to 1e-3 of a standard error.
/// Throws InvalidInput for a place beyond the parameters and a width that is not positive;
/// Interrupted.
ProfileInterval profile_interval(const std::vector<Curve>& curves,
                                 const std::vector<ForwardModel*>& models,
                                 const CurveFitOptions& options, const CurveFit& fit,
                                 std::size_t place, double half_width);

/// Where to start a fit of E and G, the least loss first.
struct ScaledStarts {
  std::vector<Eigen::VectorXd> valleys;  ///< their loss is below that of their neighbours in nu
  std::vector<Eigen::VectorXd> others;
};

/// At every Poisson's ratio of `poissons_ratios` the rubber whose values meet the curves best,
/// found from one evaluation, because forces and stresses at given kinematics are proportional to
/// (E, G) at held nu. Other parameters keep their start. Ratios at which a model has no answer are
/// left out, moduli are cut off at their bounds. Throws InvalidInput unless E and G both are free,
/// and for ratios outside of (-1, 1/2).
ScaledStarts scaled_starts(const std::vector<Curve>& curves,
                           const std::vector<ForwardModel*>& models, const CurveFitOptions& options,
                           std::vector<double> poissons_ratios);

/// The start with all stiffnesses among the parameters (what is in Pa or N/m) multiplied by one
/// factor, the one that meets the curves best; none where the values are not proportional to them
/// together, as with one of E and G held, by Euler's theorem: sum p dF/dp = F.
std::optional<Eigen::VectorXd> scaled_start(const std::vector<Curve>& curves,
                                            const std::vector<ForwardModel*>& models,
                                            const CurveFitOptions& options);

}  // namespace fingertip::calibration::inline statistics
