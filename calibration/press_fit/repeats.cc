#include "calibration/press_fit/repeats.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibration/statistics/fit_statistics.h"
#include "meshes/base/dense.h"
#include "meshes/tables/interpolation.h"

namespace fingertip::calibration::inline press_fit {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr std::size_t scatter_points = 40;

/// The fitted force of one curve over its zero, among all values.
VectorXd force_of_curve(const std::vector<Curve>& curves, const CurveFit& fit,
                        const std::vector<VectorXd>& zero, std::size_t curve) {
  VectorXd all = VectorXd::Zero(first_value(curves, curves.size()));
  all.segment(first_value(curves, curve), zero[curve].size()) =
      values_of(curves[curve]) - fit.residuals[curve] - zero[curve];
  return all;
}

/// Factors by linear least squares beside what each repeat has for itself; how the parameters then
/// change.
VectorXd fit_factors(Repeats& repeats, const std::vector<Curve>& curves, const CurveFit& fit,
                     const std::vector<std::size_t>& nuisance, const std::vector<VectorXd>& zero) {
  const Index rows = first_value(curves, curves.size()), count = Index(repeats.places.size());
  VectorXd residuals = VectorXd::Zero(rows);
  Index values = 0;
  for (const std::size_t curve : repeats.places) {
    residuals.segment(first_value(curves, curve), fit.residuals[curve].size()) =
        fit.residuals[curve];
    values += fit.residuals[curve].size();
  }
  MatrixXd columns(rows, count + Index(nuisance.size()));
  for (Index k = 0; k < count; ++k)
    columns.col(k) =
        fit.whitening * force_of_curve(curves, fit, zero, repeats.places[std::size_t(k)]);
  Index used = count;
  std::vector<std::size_t> places;
  for (const std::size_t parameter : nuisance) {
    // Only the group's rows: others have theirs.
    VectorXd column = VectorXd::Zero(rows);
    for (const std::size_t curve : repeats.places) {
      const Index from = first_value(curves, curve), size = Index(curves[curve].y.size());
      column.segment(from, size) = fit.jacobian.col(Index(parameter)).segment(from, size);
    }
    if (!(column.norm() > 0.0)) continue;
    columns.col(used++) = column;
    places.push_back(parameter);
  }
  const MatrixXd used_columns = columns.leftCols(used);
  const VectorXd target = fit.whitening * residuals,
                 found = meshes::least_squares(used_columns, target);
  const MatrixXd covariance = meshes::pseudo_inverse(used_columns.transpose() * used_columns);
  const Index freedom = std::max<Index>(1, values - used);
  const double variance = (target - used_columns * found).squaredNorm() / double(freedom);
  // Where sigma was given residuals should be 1; of larger ones the data speak themselves.
  const double scale = fit.chi_square ? std::max(1.0, variance) : variance;
  for (Index k = 0; k < count; ++k) {
    repeats.factors.push_back(1.0 + found(k));
    repeats.factor_errors.push_back(std::sqrt(scale * covariance(k, k)));
  }
  VectorXd changes = VectorXd::Zero(fit.estimates.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    changes(Index(places[i])) = found(count + Index(i));
  return changes;
}

/// Method of moments.
void find_deviation(Repeats& repeats) {
  const auto count = double(repeats.factors.size());
  double sum = 0.0, squares = 0.0, weighted = 0.0;
  for (std::size_t k = 0; k < repeats.factors.size(); ++k) {
    const double weight =
        1.0 / std::max(std::pow(repeats.factor_errors[k], 2), std::numeric_limits<double>::min());
    sum += weight, squares += weight * weight, weighted += weight * repeats.factors[k];
  }
  double q = 0.0;
  for (std::size_t k = 0; k < repeats.factors.size(); ++k)
    q += std::pow((repeats.factors[k] - weighted / sum) / repeats.factor_errors[k], 2);
  if (!std::isfinite(q)) return;
  repeats.probability = chi_square_above(q, int(count) - 1);
  repeats.deviation = std::sqrt(std::max(0.0, (q - (count - 1.0)) / (sum - squares / sum)));
}

/// Forces at equal travels since touch.
void tell_scatter(Repeats& repeats, const std::vector<Curve>& curves,
                  const std::vector<double>& touch, const std::vector<VectorXd>& zero) {
  double end = std::numeric_limits<double>::infinity();
  for (const std::size_t i : repeats.places) end = std::min(end, curves[i].x.back() - touch[i]);
  if (!(end > 0.0)) return;
  const auto count = double(repeats.places.size());
  for (std::size_t point = 1; point <= scatter_points; ++point) {
    const double at = end * double(point) / double(scatter_points);
    std::vector<double> forces;
    double noise = 0.0, mean = 0.0, squares = 0.0;
    for (const std::size_t i : repeats.places) {
      const VectorXd net = values_of(curves[i]) - zero[i];
      const std::vector<double> force(net.begin(), net.end());
      forces.push_back(meshes::interpolated(curves[i].x, force, at + touch[i]));
      mean += forces.back() / count;
      noise += std::pow(curves[i].course.noise, 2) / count;
    }
    for (const double each : forces) squares += std::pow(each - mean, 2);
    repeats.travel.push_back(at);
    repeats.mean.push_back(mean);
    repeats.scatter.push_back(std::sqrt(squares / (count - 1.0)));
    repeats.noise.push_back(std::sqrt(noise));
  }
}

}  // namespace

Repeats repeats_of(const std::vector<std::size_t>& group, const std::vector<Curve>& curves,
                   const CurveFit& fit, const std::vector<std::size_t>& nuisance,
                   const std::vector<FitQuantity>& touch, const std::vector<VectorXd>& zero) {
  Repeats repeats;
  repeats.places = group;
  for (const std::size_t i : group) repeats.curves.push_back(curves[i].name);
  const VectorXd own = fit.estimates + fit_factors(repeats, curves, fit, nuisance, zero);
  find_deviation(repeats);
  std::vector<double> touches;
  for (const FitQuantity& each : touch) touches.push_back(each.in(own));
  tell_scatter(repeats, curves, touches, zero);
  return repeats;
}

}  // namespace fingertip::calibration::inline press_fit
