#include "lattice/control/stiffness_estimator.h"

#include <algorithm>
#include <cmath>

namespace fingertip::lattice::inline control {

StiffnessEstimator::StiffnessEstimator(const EstimatorLimits& limits, double period)
    : limits_(limits), period_(period), forgetting_(std::exp(-period / limits.memory)) {
  reset();
}

void StiffnessEstimator::reset() {
  theta_.setZero();
  covariance_ = std::pow(limits_.spread, 2) * Eigen::Matrix2d::Identity();
}

double StiffnessEstimator::stiffness(double scheduled) const {
  return std::clamp(scheduled + theta_(0), 0.0, limits_.stiffness);
}

bool StiffnessEstimator::update(double moved, double sped_up, double force, double scheduled) {
  const Eigen::Vector2d phi(moved, period_ * sped_up);
  const double surprise = force - scheduled * moved - phi.dot(theta_);
  if (!std::isfinite(surprise)) {
    reset();
    return false;
  }
  if (limits_.spread * phi.norm() < limits_.noise) return false;
  const Eigen::Vector2d spread = covariance_ * phi;
  const double expected = forgetting_ * std::pow(limits_.noise, 2) + phi.dot(spread);
  theta_ += spread * (surprise / expected);
  covariance_ = (covariance_ - spread * spread.transpose() / expected) / forgetting_;
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
  const double most = 2.0 * std::pow(limits_.spread, 2);
  if (covariance_.trace() > most) covariance_ *= most / covariance_.trace();
  theta_(0) = std::clamp(theta_(0), -scheduled, limits_.stiffness - scheduled);
  theta_(1) = std::clamp(theta_(1), 0.0, limits_.damping / period_);
  if (!covariance_.allFinite() || !theta_.allFinite()) reset();
  return true;
}

}  // namespace fingertip::lattice::inline control
