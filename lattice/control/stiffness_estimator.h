/// Local stiffness and damping of a contact from increments of force and motion.
#pragma once

#include <Eigen/Core>

namespace fingertip::lattice::inline control {

/// Bounds within which a StiffnessEstimator believes what it finds.
struct EstimatorLimits {
  double stiffness = 1000.0;  ///< largest [N/m], > 0
  double spread = 1000.0;     ///< standard deviation of the stiffness before the first datum [N/m]
  double damping = 10.0;      ///< largest [N s/m], > 0
  double noise = 1e-4;        ///< standard deviation of a force increment [N], > 0
  double memory = 0.010;      ///< time constant of forgetting [s], > 0
};

/// Recursive least squares with forgetting for dF = k dx + c dv, one update per period T
/// (Astrom & Wittenmark, Adaptive Control, sections 2.2 and 11.5): with the regressor
/// (dx, T dv), parameters (k, c/T), covariance P and g = P phi/(lambda r + phi' P phi),
///   theta += g (dF - phi' theta),  P = (P - g phi' P)/lambda,  lambda = exp(-T/memory).
/// Safeguards: increments in which a stiffness of that spread would not stand out from the noise
/// are left out (dead zone); theta stays within the limits (projection); P is not forgotten beyond
/// what it was in the beginning (trace limit); what is no number starts it afresh. A scheduled
/// stiffness is taken off the data, so that only its error is estimated, and k with it stays >= 0.
class StiffnessEstimator {
 public:
  StiffnessEstimator(const EstimatorLimits& limits, double period);

  /// Increments over a period: of position [m], velocity [m/s] and force [N]; `scheduled` [N/m] is
  /// what the stiffness is expected to be. Returns whether they were used.
  bool update(double moved, double sped_up, double force, double scheduled = 0.0);
  /// Nothing is known beyond the schedule.
  void reset();

  double stiffness(double scheduled = 0.0) const;         ///< k [N/m], within 0 and the limit
  double damping() const { return theta_(1) * period_; }  ///< c [N s/m]
  const Eigen::Matrix2d& covariance() const { return covariance_; }  ///< of (k, c/T) [N²/m²]

 private:
  EstimatorLimits limits_;
  double period_, forgetting_;
  Eigen::Vector2d theta_;
  Eigen::Matrix2d covariance_;
};

}  // namespace fingertip::lattice::inline control
