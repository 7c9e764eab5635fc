#include "calibration/fit_statistics.h"

#include <Eigen/SVD>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstdio>

namespace fingertip::calibration {

using Eigen::Index;

namespace {

constexpr double upper_tail = 0.975;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

/// The largest component becomes 1.
Eigen::VectorXd normalised(const Eigen::VectorXd& direction) {
  Index largest = 0;
  direction.cwiseAbs().maxCoeff(&largest);
  return direction / direction(largest);
}

std::string statement_of(const Direction& direction,
                         const std::vector<MaterialParameter>& parameters) {
  const std::string changes = describe_changes(direction.changes, parameters);
  if (parameters.size() == 1)
    return "the curves do not determine " + std::string(name(parameters.front())) +
           ": its 95 % interval is +-" + number(100.0 * direction.interval) + " % of its size";
  return "the curves hardly see the change " + changes +
         " (of each parameter over its size): along it the 95 % interval is +-" +
         number(100.0 * direction.interval) + " %, and forces respond " +
         number(direction.relative_singular_value) +
         " times as strongly as to the best-seen change";
}

}  // namespace

double student_95(int degrees_of_freedom) {
  return quantile(boost::math::students_t(degrees_of_freedom), upper_tail);
}

double normal_95() {
  return quantile(boost::math::normal(), upper_tail);
}

double chi_square_above(double chi_square, int degrees_of_freedom) {
  return cdf(complement(boost::math::chi_squared(degrees_of_freedom), chi_square));
}

Sensitivity::Sensitivity(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& sizes)
    : sizes_(sizes), values_(Eigen::VectorXd::Zero(sizes.size())) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian * sizes.asDiagonal(), Eigen::ComputeFullV);
  values_.head(svd.singularValues().size()) = svd.singularValues();
  directions_ = svd.matrixV();
}

Eigen::MatrixXd Sensitivity::covariance() const {
  Eigen::MatrixXd root = sizes_.asDiagonal() * directions_;
  for (Index i = 0; i < values_.size(); ++i)
    root.col(i) /= std::max({values_(i), 1e-15 * values_(0), 1e-150});
  return root * root.transpose();
}

void describe_sensitivity(PressFit& fit, const Eigen::MatrixXd& curves,
                          const Eigen::MatrixXd& priors, const Eigen::VectorXd& sizes,
                          double threshold, double quantile) {
  const Sensitivity seen(curves, sizes);
  const Eigen::VectorXd inverse = sizes.cwiseInverse();
  const Eigen::MatrixXd relative = inverse.asDiagonal() * fit.covariance * inverse.asDiagonal();
  fit.singular_values = seen.singular_values();
  for (Index i = 0; i < sizes.size(); ++i) {
    const Eigen::VectorXd unit = seen.directions().col(i);
    const double value = fit.singular_values(i), largest = unit.cwiseAbs().maxCoeff();
    const double share = fit.singular_values(0) > 0.0 ? value / fit.singular_values(0) : 0.0;
    if (share >= threshold && quantile * largest <= value) continue;
    // A step t along unit/largest is the coordinate unit·change times `largest`.
    const double interval = quantile * largest * std::sqrt(unit.dot(relative * unit));
    Direction direction{normalised(unit), share, interval, {}};
    direction.statement = statement_of(direction, fit.parameters);
    const double from_priors = (priors * sizes.cwiseProduct(unit)).norm();
    const bool closed = from_priors > value && interval <= 1.0;
    (closed ? fit.only_from_priors : fit.unidentifiable).push_back(direction);
  }
}

std::string describe_changes(const Eigen::VectorXd& changes,
                             const std::vector<MaterialParameter>& parameters) {
  std::string text;
  for (Index i = 0; i < changes.size(); ++i) {
    if (std::abs(changes(i)) < 5e-3) continue;
    text += (text.empty() ? "" : ", ") + std::string(name(parameters[std::size_t(i)])) +
            (changes(i) < 0.0 ? " - " : " + ") + number(std::abs(changes(i)));
  }
  return text;
}

}  // namespace fingertip::calibration
