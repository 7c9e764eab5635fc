#include "calibration/statistics/posterior.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "calibration/statistics/curve_fit.h"
#include "calibration/statistics/fit_statistics.h"

namespace fingertip::calibration::inline statistics {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// A value this many deviations off, the misfit taken out, is no noise: one in 150 000.
constexpr double odd = 4.5;

std::vector<Curve> with_sigma(std::vector<Curve> curves, const VectorXd& sigma) {
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const VectorXd own = sigma.segment(first_value(curves, i), Index(curves[i].y.size()));
    curves[i].sigma.assign(own.begin(), own.end());
  }
  return curves;
}

/// Values that are no noise, `left` over the noise being what is missed; of so many that they are
/// no exceptions none is.
std::vector<OddValue> odd_of(const std::vector<Curve>& curves, const VectorXd& left) {
  constexpr std::size_t one_in = 25;
  std::vector<OddValue> found;
  std::size_t values = 0;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    values += curves[i].y.size();
    for (std::size_t k = 0; k < curves[i].y.size(); ++k)
      if (std::abs(left(first_value(curves, i) + Index(k))) > odd) found.push_back({i, k});
  }
  if (found.size() > values / one_in) found.clear();
  return found;
}

}  // namespace

void put_normal_priors(std::vector<FreeParameter>& free, const std::vector<FreeParameter>& told,
                       const VectorXd& estimates, bool open) {
  constexpr double far = 50.0;
  for (std::size_t j = 0; j < free.size(); ++j) {
    const std::optional<Prior>& own = told[j].prior;
    if (!own || !own->heavy_tails) continue;
    const double widths = open ? far : (estimates(Index(j)) - own->mean) / own->deviation;
    free[j].prior->deviation =
        own->deviation * std::sqrt(0.5 * (1.0 + std::max(1.0, widths * widths)));
  }
}

LinearisedFit linearised(const std::vector<Curve>& curves, const std::vector<ForwardModel*>& models,
                         const std::vector<FreeParameter>& free, const VectorXd& estimates) {
  LinearisedFit at;
  at.estimates = estimates;
  at.free = free;
  at.residuals = all_values(curves);
  at.jacobian.resize(at.residuals.size(), estimates.size());
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const CurveSlopes slopes = models[i]->evaluate(estimates);
    const auto rows = Eigen::seqN(first_value(curves, i), slopes.value.size());
    at.residuals(rows) -= slopes.value;
    at.jacobian(rows, Eigen::all) = slopes.jacobian;
  }
  return at;
}

Posterior posterior_fit(const PosteriorInput& input, const CurveFit& first) {
  constexpr int rounds = 12;
  constexpr double close = 0.05;  // of a standard error
  const VectorXd values = all_values(input.curves);
  const VectorXd& plain = input.deviations;
  Posterior result{input.curves, input.options, first, {}, {}};
  VectorXd deviations = plain;
  for (int round = 0; round < rounds; ++round) {
    put_normal_priors(result.options.free, input.options.free, result.fit.estimates,
                      input.begins_open && round == 0);
    LinearisedFit at =
        linearised(input.curves, input.models, result.options.free, result.fit.estimates);
    const VectorXd computed = values - at.residuals;
    at.deviations = deviations;
    at.noise_told = input.noise_told;
    if (!input.noise_told)
      at.least_noise = input.least_told * computed.cwiseAbs().maxCoeff() / plain.minCoeff();
    at.model_covariance = input.options.model_covariance;
    std::vector<ErrorComponent> components = input.components(at.estimates, computed);
    // What scatters is no misfit: parameters that have taken it up give it back first.
    if (round == 0 && components.size() > 1) components.erase(components.begin());
    result.errors = value_errors(at, components);
    result.curves = with_sigma(input.curves, result.errors.noise * deviations);
    result.options.model_covariance = result.errors.covariance_of_values;
    result.options.start_once();
    for (std::size_t j = 0; j < result.options.free.size(); ++j)
      result.options.free[j].start =
          std::clamp(result.fit.estimates(Index(j)), result.options.free[j].lower,
                     result.options.free[j].upper);
    const CurveFit before = result.fit;
    result.fit = fit_curves(result.curves, input.models, result.options);
    result.fit.evaluations += before.evaluations;
    // What is left is noise.
    VectorXd left = at.residuals - at.jacobian * (result.errors.mean - at.estimates);
    for (const VectorXd& part : result.errors.parts) left -= part;
    const std::vector<OddValue> known = std::exchange(
        result.odd, odd_of(input.curves, left.cwiseQuotient(result.errors.noise * plain)));
    const bool changed = result.odd != known;
    deviations = plain;
    for (const OddValue& each : result.odd) {
      const Index row = first_value(input.curves, each.curve) + Index(each.place);
      deviations(row) = std::abs(left(row)) / result.errors.noise;
    }
    const VectorXd step = (result.fit.estimates - before.estimates).cwiseAbs();
    if (!changed && round > 1 && (step.array() <= close * result.fit.standard_errors.array()).all())
      break;
  }
  return result;
}

void put_posterior(const ValueErrors& errors, const std::vector<FreeParameter>& free,
                   CurveFit& fit) {
  fit.covariance = errors.covariance;
  fit.standard_errors = fit.covariance.diagonal().cwiseSqrt();
  const VectorXd inverse = fit.standard_errors.cwiseInverse();
  fit.correlation = inverse.asDiagonal() * fit.covariance * inverse.asDiagonal();
  for (Index j = 0; j < fit.estimates.size(); ++j) {
    fit.lower(j) = fit.estimates(j) - (errors.mean(j) - errors.lower(j));
    fit.upper(j) = fit.estimates(j) + (errors.upper(j) - errors.mean(j));
    const FreeParameter& own = free[std::size_t(j)];
    if (own.lower != 0.0 || !own.prior) continue;
    fit.lower(j) = std::max(fit.lower(j), own.lower);
    if (fit.estimates(j) < 0.5 * own.upper) fit.at_bound[std::size_t(j)] = false;
  }
  if (const auto slopes = ratio_slopes(fit))
    fit.poissons_ratio_error = std::sqrt(slopes->dot(fit.covariance * *slopes));
}

}  // namespace fingertip::calibration::inline statistics
