/// Curves, models and priors as one list of residuals.
#pragma once

#include <Eigen/Core>
#include <list>
#include <vector>

#include "calibration/curves/curve_fit.h"

namespace fingertip::calibration {

/// Residuals (computed minus measured) over their standard deviations, and derivatives by the
/// parameters themselves: all values, curve by curve, then all priors.
struct Linearisation {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;
};

/// Every broken rule of curves and options. Throws InvalidInput.
void check_curve_fit(const std::vector<Curve>& curves, const CurveFitOptions& options);

/// Keeps references. Every answer is remembered: a search comes back to points where it has been,
/// and a model may take minutes.
class CurveResiduals {
 public:
  CurveResiduals(const std::vector<Curve>& curves, const std::vector<ForwardModel*>& models,
                 const CurveFitOptions& options);

  Eigen::Index values() const { return deviations_.size(); }
  Eigen::Index priors() const { return priors_; }
  Eigen::Index parameters() const { return Eigen::Index(options_->free.size()); }
  bool has_sigma() const { return has_sigma_; }
  /// What residuals of values are divided by: sigma, or the values' root mean square [y].
  const Eigen::VectorXd& deviations() const { return deviations_; }
  /// A loss below which a model's own round-off decides, taken as 1e-10 of every value.
  double noise() const { return noise_; }
  /// The loss that a step of one standard error makes: 1/2 where sigma is known, else half the
  /// residual variance at `loss`; not below noise().
  double loss_of_standard_error(double loss) const;

  /// Evaluates all models, options.threads of them side by side, each distinct one once. Throws as
  /// the models do (the first curve's error goes first), NotConverged for values that are not
  /// finite, Interrupted where options.progress says so.
  const Linearisation& at(const Eigen::VectorXd& parameters);
  /// Points evaluated so far.
  int evaluations() const { return evaluations_; }
  /// Slope of the loss by half the squared residual: 1 for least squares and for priors.
  Eigen::VectorXd weights(const Linearisation& linearisation) const;
  /// Rows such that half their squared sum is the loss.
  Linearisation with_loss(const Linearisation& linearisation) const;
  /// Measured minus computed [y], per curve.
  std::vector<Eigen::VectorXd> misfit(const Linearisation& linearisation) const;

 private:
  struct Known {
    Eigen::VectorXd parameters;
    Linearisation linearisation;
  };

  std::vector<CurveSlopes> evaluate(const Eigen::VectorXd& parameters) const;

  const std::vector<Curve>* curves_;
  const std::vector<ForwardModel*>* models_;
  const CurveFitOptions* options_;
  Eigen::Index priors_ = 0;
  bool has_sigma_ = false;
  Eigen::VectorXd deviations_;
  double noise_ = 0.0;
  int evaluations_ = 0;
  std::list<Known> known_;  ///< latest first
};

}  // namespace fingertip::calibration
