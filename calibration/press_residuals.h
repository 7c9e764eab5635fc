/// Curves, models and priors as one list of residuals.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibration/press_fit.h"

namespace fingertip::calibration {

/// Residuals (computed minus measured) over their standard deviations, and derivatives by the
/// parameters themselves: all forces, curve by curve, then all priors.
struct Linearisation {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;
};

/// Every broken rule of curves and options. Throws InvalidInput.
void check_press_fit(const std::vector<Curve>& curves, const PressFitOptions& options);

/// Keeps references; the last answer is remembered, because a solver asks for residuals and
/// derivatives in turn.
class PressResiduals {
 public:
  PressResiduals(const std::vector<Curve>& curves, const std::vector<ForwardModel*>& models,
                 const PressFitOptions& options);

  Eigen::Index forces() const { return forces_; }
  Eigen::Index priors() const { return priors_; }
  Eigen::Index parameters() const { return Eigen::Index(options_->free.size()); }
  bool has_sigma() const { return has_sigma_; }
  /// What residuals of forces without sigma are divided by: their root mean square [N].
  double force_scale() const { return force_scale_; }

  /// Throws as the models do, and NotConverged for forces that are not finite.
  const Linearisation& at(const Eigen::VectorXd& parameters);
  /// Slope of the loss by half the squared residual: 1 for least squares and for priors.
  Eigen::VectorXd weights(const Linearisation& linearisation) const;
  /// Rows such that half their squared sum is the loss.
  Linearisation with_loss(const Linearisation& linearisation) const;
  /// Measured minus computed [N], per curve.
  std::vector<Eigen::VectorXd> misfit(const Linearisation& linearisation) const;

 private:
  double sigma(const Curve& curve, std::size_t i) const;

  const std::vector<Curve>* curves_;
  const std::vector<ForwardModel*>* models_;
  const PressFitOptions* options_;
  Eigen::Index forces_ = 0, priors_ = 0;
  bool has_sigma_ = false;
  double force_scale_ = 1.0;
  Eigen::VectorXd last_parameters_;
  Linearisation last_;
};

}  // namespace fingertip::calibration
