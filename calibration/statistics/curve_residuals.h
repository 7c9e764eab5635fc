/// Curves, models and priors as one list of residuals.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <list>
#include <utility>
#include <vector>

#include "calibration/statistics/curve.h"
#include "calibration/statistics/fit_options.h"
#include "calibration/statistics/forward_model.h"
#include "meshes/base/dense.h"

namespace fingertip::calibration::inline statistics {

/// Residuals (computed minus measured) over their standard deviations, and derivatives by the
/// parameters themselves: all values, curve by curve, then all priors.
struct Linearisation {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;
};

/// No further evaluation is allowed.
struct EvaluationsSpent {};

/// Every broken rule of curves and options. Throws InvalidInput.
void check_curve_fit(const std::vector<Curve>& curves, const CurveFitOptions& options);

/// Of what values scatter by [their unit]: by themselves (`deviations`) and together, by errors of
/// the model whose covariance is known; its roots whiten and colour.
meshes::EigenPairs decomposed_covariance(Eigen::MatrixXd model, const Eigen::VectorXd& deviations);

/// Keeps references. Every answer is remembered: a search comes back to points where it has been,
/// and a model may take minutes.
class CurveResiduals {
 public:
  CurveResiduals(const std::vector<Curve>& curves, const std::vector<ForwardModel*>& models,
                 const CurveFitOptions& options);

  Eigen::Index values() const { return whitening_.rows(); }
  Eigen::Index priors() const { return priors_; }
  Eigen::Index parameters() const { return Eigen::Index(options_->free.size()); }
  bool has_sigma() const { return has_sigma_; }
  /// Where sigma is not given: priors count as if every value had this deviation [y], > 0. At first
  /// options.value_deviation, else the values' root mean square, which makes them strong.
  void weigh_priors(double deviation);
  /// What residuals of values are multiplied by [1/y], symmetric: the inverse root of the
  /// covariance of sigma and model error, or one over the values' root mean square.
  const Eigen::MatrixXd& whitening() const { return whitening_; }
  /// A loss below which a model's own round-off decides, taken as 1e-10 of every value.
  double noise() const { return noise_; }
  /// The loss that a step of one standard error makes: 1/2 where sigma is known, else half the
  /// residual variance at `loss`; not below noise().
  double loss_of_standard_error(double loss) const;

  /// Evaluates all models, options.threads of them side by side, each distinct one once. Throws as
  /// the models do (the first curve's error goes first), NotConverged for values that are not
  /// finite, Interrupted where options.progress says so, EvaluationsSpent instead of evaluating
  /// more than allowed.
  const Linearisation& at(const Eigen::VectorXd& parameters);
  /// ForwardModel::refine of all models; true: what was evaluated so far is of no use any more.
  bool refine(const Eigen::VectorXd& parameters) const;
  /// Points evaluated so far.
  int evaluations() const { return evaluations_; }
  /// So many evaluations, those of the past included, may be made; without limit at first.
  void allow(int evaluations) { allowed_ = evaluations; }
  /// Where, of all points evaluated or asked for again since forget_least(), the loss was least.
  std::pair<Eigen::VectorXd, double> least() const { return {least_, min_loss_}; }
  void forget_least() { min_loss_ = std::numeric_limits<double>::infinity(); }
  /// Slope of the loss by half the squared residual: 1 for least squares and for priors.
  Eigen::VectorXd weights(const Linearisation& linearisation) const;
  /// Rows such that half their squared sum is the loss.
  Linearisation with_loss(const Linearisation& linearisation) const;
  /// Measured minus computed [y], per curve.
  std::vector<Eigen::VectorXd> misfit(const Linearisation& linearisation) const;
  /// The same times whitening(): what chi-square squares.
  std::vector<Eigen::VectorXd> whitened_misfit(const Linearisation& linearisation) const;

 private:
  struct Known {
    Eigen::VectorXd parameters;
    Linearisation linearisation;
  };

  std::vector<CurveSlopes> evaluate(const Eigen::VectorXd& parameters) const;
  std::vector<ForwardModel*> distinct_models() const;
  /// Calls `act` with 0 ... count - 1, options.threads at a time; the first error goes on.
  void side_by_side(std::size_t count, const std::function<void(std::size_t)>& act) const;
  void whiten(const Eigen::VectorXd& values, const Eigen::VectorXd& sigma);
  std::vector<Eigen::VectorXd> by_curve(const Eigen::VectorXd& all) const;
  const Linearisation& told(const Known& known);

  const std::vector<Curve>* curves_;
  const std::vector<ForwardModel*>* models_;
  const CurveFitOptions* options_;
  Eigen::Index priors_ = 0;
  bool has_sigma_ = false;
  Eigen::MatrixXd whitening_, colouring_;  ///< colouring: the inverse of whitening
  Eigen::VectorXd measured_;               ///< values of all curves [y]
  double noise_ = 0.0;
  double prior_weight_ = 1.0;  ///< of their rows, in the unit of the residuals
  int evaluations_ = 0, allowed_ = std::numeric_limits<int>::max();
  Eigen::VectorXd least_;
  double min_loss_ = std::numeric_limits<double>::infinity();
  std::list<Known> known_;  ///< latest first
};

}  // namespace fingertip::calibration::inline statistics
