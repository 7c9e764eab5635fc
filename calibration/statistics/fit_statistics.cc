#include "calibration/statistics/fit_statistics.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

#include "calibration/files/words.h"
#include "meshes/base/dense.h"

namespace fingertip::calibration::inline statistics {

using Eigen::Index;

namespace {

constexpr double upper_tail = 0.975;
/// Relative changes below this are not told.
constexpr double visible_change = 5e-3;

std::string number(double value) {
  return rounded(value, 2);
}

/// Of the directions, columns in units of the sizes, the one along which Poisson's ratio is least
/// known, where it is open; else -1.
Index opens_ratio(const CurveFit& fit, const Eigen::MatrixXd& directions,
                  const Eigen::VectorXd& sizes, const Eigen::MatrixXd& relative, double quantile) {
  const auto slopes = ratio_slopes(fit);
  if (!slopes || quantile * fit.birge_ratio * fit.poissons_ratio_error.value_or(0.0) <= open_ratio)
    return -1;
  Index widest = 0;
  const Eigen::VectorXd along = directions.transpose() * sizes.cwiseProduct(*slopes),
                        variance = (directions.transpose() * relative * directions).diagonal();
  along.cwiseAbs2().cwiseProduct(variance).maxCoeff(&widest);
  return widest;
}

/// An interval over the size of what it is about: beyond that size its digits tell nothing.
std::string interval_text(double relative) {
  return relative <= 1.0 ? "is +-" + percent(relative) : "exceeds +-100 %";
}

/// The largest component becomes 1.
Eigen::VectorXd normalised(const Eigen::VectorXd& direction) {
  Index largest = 0;
  direction.cwiseAbs().maxCoeff(&largest);
  return direction / direction(largest);
}

bool is_spring(MaterialParameter parameter) {
  return unit(parameter) == "N/m";
}

bool is_constant(MaterialParameter parameter) {
  return is_spring(parameter) || parameter == MaterialParameter::kappa;
}

/// The open combination of a lattice's constants in their own units, "k1 + 1 N/m, k2 - 1 N/m",
/// its largest spring (or else kappa) 1, and which sums of springs, which are a C44 and
/// a (C11 - kappa), it leaves as they are; empty without such constants,
/// and where other parameters change, too.
std::string open_combination(const Eigen::VectorXd& change, const Eigen::VectorXd& relative,
                             const std::vector<MaterialParameter>& parameters) {
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (!is_constant(parameters[i]) && std::abs(relative(Index(i))) >= visible_change) return {};
  double unit_change = 0.0, k1 = 0.0, k2 = 0.0, k3 = 0.0;
  const bool springs = std::ranges::any_of(parameters, is_spring);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i] == MaterialParameter::k1) k1 = change(Index(i));
    if (parameters[i] == MaterialParameter::k2) k2 = change(Index(i));
    if (parameters[i] == MaterialParameter::k3) k3 = change(Index(i));
    if (is_spring(parameters[i])) unit_change = std::max(unit_change, std::abs(change(Index(i))));
  }
  if (!springs || unit_change == 0.0) return {};
  std::string text;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const double value = change(Index(i)) / unit_change;
    const bool small = is_spring(parameters[i]) && std::abs(value) < visible_change;
    if (small || !is_constant(parameters[i]) || value == 0.0) continue;
    text += (text.empty() ? "" : ", ") + std::string(name(parameters[i])) +
            (value < 0.0 ? " - " : " + ") + number(std::abs(value)) + " " +
            std::string(unit(parameters[i]));
  }
  text = "; what is open is " + text + " times any number";
  // Stays: to 5 % of what its parts change by.
  const auto stays = [](double a, double b, double c) {
    return std::abs(a + b + c) < 0.05 * (std::abs(a) + std::abs(b) + std::abs(c));
  };
  const bool shear = stays(0.0, k2, 4.0 / 3.0 * k3), axial = stays(k1, 2.0 * k2, 4.0 / 3.0 * k3);
  if (shear || axial)
    text += ", which keeps " + std::string(shear ? "k2 + 4/3 k3 (the shear modulus)" : "") +
            (shear && axial ? " and " : "") +
            (axial ? "k1 + 2 k2 + 4/3 k3 (the springs' axial stiffness)" : "");
  return text;
}

/// "youngs_modulus + 1, shear_modulus - 0.75": changes over the parameters' sizes.
std::string describe_changes(const Eigen::VectorXd& changes,
                             const std::vector<std::string>& labels) {
  std::string text;
  for (Index i = 0; i < changes.size(); ++i) {
    if (std::abs(changes(i)) < visible_change) continue;
    text += (text.empty() ? "" : ", ") + labels[std::size_t(i)] +
            (changes(i) < 0.0 ? " - " : " + ") + number(std::abs(changes(i)));
  }
  return text;
}

/// `change` is the direction in the parameters' units.
std::string statement_of(const Direction& direction, const Eigen::VectorXd& change,
                         const CurveFit& fit) {
  const std::string changes = describe_changes(direction.changes, fit.labels);
  if (fit.labels.size() == 1)
    return "the curves do not determine " + fit.labels.front() + ": its 95 % interval " +
           interval_text(direction.interval) + " of its size";
  return "the curves hardly see the change " + changes +
         " (of each parameter over its size): along it the 95 % interval " +
         interval_text(direction.interval) + ", and the values respond " +
         number(direction.relative_singular_value) +
         " times as strongly as to the best-seen change" +
         open_combination(change, direction.changes, fit.parameters);
}

}  // namespace

double student_95(double degrees_of_freedom) {
  return quantile(boost::math::students_t(degrees_of_freedom), upper_tail);
}

double normal_95() {
  return quantile(boost::math::normal(), upper_tail);
}

double mixture_point(const std::vector<double>& means, const std::vector<double>& deviations,
                     const std::vector<double>& weights, double share) {
  constexpr int halvings = 40;
  double low = means.front(), high = low;
  for (std::size_t i = 0; i < means.size(); ++i) {
    low = std::min(low, means[i] - 10.0 * deviations[i]);
    high = std::max(high, means[i] + 10.0 * deviations[i]);
  }
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (low + high);
    double below = 0.0;
    // Boost's distribution counts in long doubles, which take ten times as long.
    for (std::size_t k = 0; k < means.size(); ++k)
      below += weights[k] * (deviations[k] > 0.0
                                 ? 0.5 * std::erfc((means[k] - middle) / (M_SQRT2 * deviations[k]))
                                 : double(means[k] <= middle));
    (below < share ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double chi_square_above(double chi_square, int degrees_of_freedom) {
  return cdf(complement(boost::math::chi_squared(degrees_of_freedom), chi_square));
}

Sensitivity::Sensitivity(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& sizes)
    : sizes_(sizes), values_(Eigen::VectorXd::Zero(sizes.size())) {
  const meshes::SingularValues svd = meshes::singular_values(jacobian * sizes.asDiagonal());
  values_.head(svd.values.size()) = svd.values;
  directions_ = svd.right;
}

Eigen::MatrixXd Sensitivity::covariance() const {
  Eigen::MatrixXd root = sizes_.asDiagonal() * directions_;
  for (Index i = 0; i < values_.size(); ++i)
    root.col(i) /= std::max({values_(i), 1e-15 * values_(0), 1e-150});
  return root * root.transpose();
}

double aicc_penalty(double n, double k) {
  if (n <= k + 1.0) return std::numeric_limits<double>::infinity();
  return 2.0 * k + 2.0 * k * (k + 1.0) / (n - k - 1.0);
}

std::optional<Eigen::VectorXd> ratio_slopes(const CurveFit& fit) {
  const auto place = [&](MaterialParameter parameter) {
    return std::ranges::find(fit.parameters, parameter) - fit.parameters.begin();
  };
  const Index e = place(MaterialParameter::youngs_modulus),
              g = place(MaterialParameter::shear_modulus), count = Index(fit.parameters.size());
  if (std::max(e, g) == count) return std::nullopt;
  Eigen::VectorXd slopes = Eigen::VectorXd::Zero(count);
  slopes(e) = 0.5 / fit.estimates(g);
  slopes(g) = -0.5 * fit.estimates(e) / std::pow(fit.estimates(g), 2);
  return slopes;
}

void describe_sensitivity(CurveFit& fit, const Eigen::MatrixXd& priors,
                          const Eigen::VectorXd& sizes, double threshold, double quantile) {
  const Sensitivity seen(fit.jacobian, sizes);
  const Eigen::VectorXd inverse = sizes.cwiseInverse();
  const Eigen::MatrixXd relative = inverse.asDiagonal() * fit.covariance * inverse.asDiagonal();
  fit.singular_values = seen.singular_values();
  const Index ratio = opens_ratio(fit, seen.directions(), sizes, relative, quantile);
  for (Index i = 0; i < sizes.size(); ++i) {
    const Eigen::VectorXd unit = seen.directions().col(i);
    const double value = fit.singular_values(i), largest = unit.cwiseAbs().maxCoeff();
    const double share = fit.singular_values(0) > 0.0 ? value / fit.singular_values(0) : 0.0;
    if (share >= threshold && quantile * largest <= value && i != ratio) continue;
    // A step t along unit/largest is the coordinate unit·change times `largest`.
    const double interval = quantile * largest * std::sqrt(unit.dot(relative * unit));
    Direction direction{normalised(unit), share, interval, {}};
    direction.statement = statement_of(direction, sizes.cwiseProduct(direction.changes), fit);
    const double from_priors = (priors * sizes.cwiseProduct(unit)).norm();
    const bool closed = from_priors > value && interval <= 1.0 && i != ratio;
    (closed ? fit.only_from_priors : fit.unidentifiable).push_back(direction);
  }
}

}  // namespace fingertip::calibration::inline statistics
