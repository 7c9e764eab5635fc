#include "calibration/statistics/curve_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "calibration/statistics/curve_minimum.h"
#include "calibration/statistics/curve_residuals.h"
#include "calibration/statistics/fit_coordinates.h"
#include "calibration/statistics/fit_statistics.h"
#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::calibration::inline statistics {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Less than one good fit in a hundred has so large a chi-square.
constexpr double improbable = 0.01;

/// The least loss; a minimum rather than what a search that ran out has seen less than a tenth of a
/// standard error below it.
const Minimum& best_of(const std::vector<Minimum>& minima, const CurveResiduals& residuals) {
  const Minimum& least = *std::ranges::min_element(minima, {}, &Minimum::loss);
  const double close = least.loss + 0.01 * residuals.loss_of_standard_error(least.loss);
  const Minimum* best = &least;
  for (const Minimum& minimum : minima)
    if (!best->converged && minimum.converged && minimum.loss <= close) best = &minimum;
  return *best;
}

/// Poisson's ratio where E and G are sought and it is at a bound.
std::optional<double> ratio_bound(const VectorXd& estimates, const CurveFitOptions& options) {
  const FitCoordinates coordinates(options);
  const auto places = coordinates.rubber();
  if (!places) return std::nullopt;
  const auto [e, g] = *places;
  const double x = coordinates.from(estimates)(e);
  if (x > 1.001 * coordinates.lower()(e) && x < (1.0 - 1e-9) * coordinates.upper()(e))
    return std::nullopt;
  return estimates(e) / (2.0 * estimates(g)) - 1.0;
}

/// At a bound of Poisson's ratio, and where sigma tells it the data are not met there.
bool ends_badly(const Minimum& minimum, const CurveResiduals& residuals,
                const CurveFitOptions& options) {
  if (!ratio_bound(minimum.estimates, options)) return false;
  const Index freedom = residuals.values() + residuals.priors() - minimum.estimates.size();
  return !residuals.has_sigma() || freedom <= 0 ||
         chi_square_above(2.0 * minimum.loss, int(freedom)) < improbable;
}

/// From the start, then from the others, each with its share of the evaluations that are left; from
/// those in reserve while the least ends badly. Without an answer at one of the others there is no
/// minimum from there.
std::vector<Minimum> minima_from(CurveResiduals& residuals, const CurveFitOptions& options) {
  std::vector<VectorXd> starts = options.other_starts;
  starts.insert(starts.begin(), start_of(options));
  const std::size_t needed = starts.size();
  starts.insert(starts.end(), options.reserve_starts.begin(), options.reserve_starts.end());
  std::vector<Minimum> minima;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    if (i >= needed && !ends_badly(best_of(minima, residuals), residuals, options)) break;
    const int used = residuals.evaluations(),
              shares = int((i < needed ? needed : starts.size()) - i);
    if (i >= needed && used >= options.max_evaluations) break;
    residuals.allow(used + std::max(1, (options.max_evaluations - used) / shares));
    try {
      minima.push_back(minimise(residuals, options, starts[i]));
    } catch (const meshes::NotConverged&) {
      if (i == 0) throw;
    }
  }
  return minima;
}

/// sqrt(sum of squares / degrees of freedom) of the data alone [y].
double deviation_of(CurveResiduals& residuals, const VectorXd& estimates) {
  const Linearisation& at = residuals.at(estimates);
  const double squares = sum_of_squares(residuals.misfit(at));
  return std::sqrt(squares / double(std::max<Index>(1, at.residuals.size() - estimates.size())));
}

/// Without sigma the fit's own residuals tell what priors are weighed against: sought again until
/// the two agree.
void agree_with_priors(CurveResiduals& residuals, const CurveFitOptions& options,
                       std::vector<Minimum>& minima) {
  constexpr int rounds = 10;
  constexpr double close = 1e-3;
  double known = 0.0;
  for (int round = 0; round < rounds; ++round) {
    const VectorXd start = best_of(minima, residuals).estimates;
    const double deviation = deviation_of(residuals, start);
    if (!(deviation > 0.0) || std::abs(deviation - known) <= close * deviation) return;
    known = deviation;
    residuals.weigh_priors(deviation);
    residuals.allow(std::max(options.max_evaluations, residuals.evaluations() + 1));
    minima = {minimise(residuals, options, start)};
  }
}

/// What a relative change refers to: the estimate, and for what may be zero at least its size.
VectorXd sizes(const VectorXd& estimates, const CurveFitOptions& options) {
  VectorXd sizes = estimates.cwiseAbs();
  for (std::size_t i = 0; i < options.free.size(); ++i)
    if (!varies_by_logarithm(options.free[i]))
      sizes(Index(i)) = std::max(sizes(Index(i)), size_of(options.free[i]));
  return sizes;
}

void add_uncertainty(CurveFit& fit, const Eigen::MatrixXd& covariance, double quantile) {
  fit.covariance = covariance;
  fit.standard_errors = fit.covariance.diagonal().cwiseSqrt();
  const VectorXd inverse = fit.standard_errors.cwiseInverse();
  fit.correlation = inverse.asDiagonal() * fit.covariance * inverse.asDiagonal();
  fit.lower = fit.estimates - quantile * fit.birge_ratio * fit.standard_errors;
  fit.upper = fit.estimates + quantile * fit.birge_ratio * fit.standard_errors;
}

void add_bounds(CurveFit& fit, const CurveFitOptions& options) {
  for (std::size_t i = 0; i < options.free.size(); ++i) {
    const double p = fit.estimates(Index(i)), near = 1e-9 * size_of(options.free[i]);
    fit.at_bound.push_back(p - lower_bound(options.free[i]) <= near ||
                           options.free[i].upper - p <= near);
  }
  fit.poissons_ratio_bound = ratio_bound(fit.estimates, options);
  if (fit.poissons_ratio_bound)
    fit.at_bound[std::size_t(FitCoordinates(options).rubber()->first)] = true;
}

/// Squares of the residuals, and of the priors' where sigma weighs both; the deviation of one
/// residual that follows, in their unit.
double add_squares(CurveFit& fit, const CurveResiduals& residuals, const Linearisation& at,
                   const CurveFitOptions& options) {
  fit.residuals = residuals.misfit(at);
  fit.degrees_of_freedom = int(at.residuals.size() - fit.estimates.size());
  const double squares = sum_of_squares(fit.residuals);
  if (fit.degrees_of_freedom > 0)
    fit.residual_deviation = std::sqrt(squares / fit.degrees_of_freedom);
  if (!residuals.has_sigma())
    return std::max(fit.residual_deviation * residuals.whitening()(0, 0), 1e-150);
  fit.whitened_residuals = residuals.whitened_misfit(at);
  if (options.robust_width == 0.0) {
    fit.chi_square = at.residuals.squaredNorm();
    if (fit.degrees_of_freedom > 0) {
      fit.chi_square_probability = chi_square_above(*fit.chi_square, fit.degrees_of_freedom);
      if (*fit.chi_square_probability < improbable)
        fit.birge_ratio = std::sqrt(*fit.chi_square / fit.degrees_of_freedom);
    }
  }
  return 1.0;
}

}  // namespace

CurveFit fit_curves(const std::vector<Curve>& curves, const std::vector<ForwardModel*>& models,
                    const CurveFitOptions& options) {
  check_curve_fit(curves, options);
  if (models.size() != curves.size())
    throw meshes::InvalidInput({"models", std::to_string(models.size()),
                                "every curve needs its model", "give one per curve"});
  CurveFit fit;
  fit.parameters = parameters_in(options);
  for (const FreeParameter& free : options.free) fit.labels.push_back(label(free));
  // Anew from all starts where models have learnt at the end of a search: another may lead further.
  std::optional<CurveResiduals> latest;
  do {
    latest.emplace(curves, models, options);
    fit.minima = minima_from(*latest, options);
    const bool open = !latest->has_sigma() && latest->priors() > 0;
    if (open && options.value_deviation == 0.0) agree_with_priors(*latest, options, fit.minima);
  } while (latest->refine(best_of(fit.minima, *latest).estimates));
  CurveResiduals& residuals = *latest;
  residuals.allow(std::numeric_limits<int>::max());
  const Minimum& best = best_of(fit.minima, residuals);
  fit.estimates = best.estimates;
  fit.iterations = best.iterations;
  fit.converged = best.converged;
  fit.evaluations = residuals.evaluations();
  const Linearisation& at = residuals.at(fit.estimates);
  const double deviation = add_squares(fit, residuals, at, options);
  const double quantile = residuals.has_sigma() ? normal_95() : student_95(fit.degrees_of_freedom);
  const VectorXd root = residuals.weights(at).cwiseSqrt();
  const Eigen::MatrixXd jacobian = root.asDiagonal() * at.jacobian / deviation;
  fit.jacobian = jacobian.topRows(residuals.values());
  fit.whitening = root.head(residuals.values()).asDiagonal() * residuals.whitening() / deviation;
  const VectorXd size = sizes(fit.estimates, options);
  Eigen::MatrixXd covariance = Sensitivity(jacobian, size).covariance();
  fit.influence = covariance * fit.jacobian.transpose() * fit.whitening;
  // Found without regard to the models' errors, which come through.
  if (!residuals.has_sigma() && options.model_covariance.size() > 0)
    covariance += fit.influence * options.model_covariance * fit.influence.transpose();
  add_uncertainty(fit, covariance, quantile);
  if (const auto slopes = ratio_slopes(fit))
    fit.poissons_ratio_error = std::sqrt(slopes->dot(fit.covariance * *slopes));
  add_bounds(fit, options);
  describe_sensitivity(fit, jacobian.bottomRows(residuals.priors()), size,
                       options.relative_singular_value, quantile);
  return fit;
}

}  // namespace fingertip::calibration::inline statistics
