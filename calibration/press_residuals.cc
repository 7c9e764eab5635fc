#include "calibration/press_residuals.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "calibration/press_minimum.h"
#include "meshes/errors.h"
#include "meshes/files.h"

namespace fingertip::calibration {

using Eigen::Index;
using meshes::to_text;
using meshes::Violation;

namespace {

void add_values(std::vector<Violation>& found, const Curve& curve, const std::string& key) {
  const auto positive = [](double value) { return std::isfinite(value) && value > 0.0; };
  for (std::size_t i = 0; i < curve.indentation.size(); ++i) {
    const double depth = curve.indentation[i];
    if (!positive(depth) || (i > 0 && depth <= curve.indentation[i - 1])) {
      found.push_back({key + ".indentation", to_text(depth) + " m",
                       "indentations must be finite, positive and increasing",
                       "sort the points and remove those before contact or twice there"});
      break;
    }
  }
  for (const double force : curve.force)
    if (!std::isfinite(force)) {
      found.push_back(
          {key + ".force", to_text(force) + " N", "forces must be finite", "remove the point"});
      break;
    }
  for (const double sigma : curve.sigma)
    if (!positive(sigma)) {
      found.push_back({key + ".sigma", to_text(sigma) + " N",
                       "standard deviations must be finite and positive",
                       "give that of each force, or none at all"});
      break;
    }
}

void add_curves(std::vector<Violation>& found, const std::vector<Curve>& curves) {
  if (curves.empty())
    found.push_back({"curves", "none", "a fit needs at least one curve", "give one"});
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const Curve& curve = curves[c];
    const std::string key = "curves[" + std::to_string(c) + "]";
    const std::size_t points = curve.indentation.size();
    if (points == 0) found.push_back({key, "empty", "a curve needs points", "give its points"});
    if (curve.force.size() != points)
      found.push_back({key + ".force", std::to_string(curve.force.size()) + " values",
                       "there must be as many forces as indentations", "complete the list"});
    if (!curve.sigma.empty() && curve.sigma.size() != points)
      found.push_back({key + ".sigma", std::to_string(curve.sigma.size()) + " values",
                       "there must be one standard deviation per force, or none",
                       "complete the list"});
    if (curve.sigma.empty() != curves.front().sigma.empty())
      found.push_back({key + ".sigma", curve.sigma.empty() ? "none" : "given",
                       "either every curve has standard deviations or none has: they are weights",
                       "complete or remove them"});
    add_values(found, curve, key);
  }
}

bool valid_prior(const Prior& prior) {
  return std::isfinite(prior.mean) && std::isfinite(prior.deviation) && prior.deviation > 0.0;
}

bool within_bounds(const Eigen::VectorXd& start, const PressFitOptions& options) {
  for (std::size_t i = 0; i < options.free.size(); ++i) {
    const double value = start(Index(i));
    const FreeParameter& free = options.free[i];
    if (!std::isfinite(value) || value < free.lower || value > free.upper) return false;
    if (varies_by_logarithm(free) && value <= 0.0) return false;
  }
  return true;
}

void add_parameters(std::vector<Violation>& found, const PressFitOptions& options, bool has_sigma) {
  for (const FreeParameter& free : options.free) {
    const std::string key = "free." + std::string(name(free.parameter));
    if (!std::isfinite(free.start) || !(free.start >= free.lower && free.start <= free.upper) ||
        !(free.lower < free.upper) || (varies_by_logarithm(free) && free.start <= 0.0))
      found.push_back(
          {key + ".start", to_text(free.start),
           "the start must be finite, within its bounds, and positive for E, G and factors",
           "move it, or the bounds"});
    if (!std::isfinite(free.scale) || free.scale < 0.0 || (free.scale == 0.0 && free.start == 0.0))
      found.push_back({key + ".scale", to_text(free.scale),
                       "a typical size must be positive, and given for a start at 0", "give it"});
    if (!free.prior) continue;
    if (!valid_prior(*free.prior))
      found.push_back({key + ".prior", to_text(free.prior->deviation),
                       "a prior has a finite mean and a finite, positive standard deviation",
                       "give both in the parameter's unit"});
    if (!has_sigma)
      found.push_back({key + ".prior", "without sigma",
                       "a prior is weighed against forces of known standard deviation",
                       "give the curves' sigma"});
  }
}

}  // namespace

void check_press_fit(const std::vector<Curve>& curves, const PressFitOptions& options) {
  std::vector<Violation> found;
  add_curves(found, curves);
  const bool has_sigma = !curves.empty() && !curves.front().sigma.empty();
  if (options.free.empty())
    found.push_back({"free", "none", "a fit needs a free parameter", "name at least one"});
  add_parameters(found, options, has_sigma);
  if (!std::isfinite(options.robust_width) || options.robust_width < 0.0 ||
      (options.robust_width > 0.0 && !has_sigma))
    found.push_back({"robust_width", to_text(options.robust_width),
                     "the width must be finite, not negative, and counts in sigma",
                     "give the curves' sigma, or 0"});
  for (const Eigen::VectorXd& start : options.other_starts)
    if (start.size() != Index(options.free.size()) || !within_bounds(start, options))
      found.push_back({"other_starts", std::to_string(start.size()) + " values",
                       "a start has a finite value within its bounds for every free parameter",
                       "complete or move it"});
  if (options.max_iterations < 1)
    found.push_back({"max_iterations", std::to_string(options.max_iterations),
                     "a fit needs an iteration", "give 1 or more"});
  std::size_t rows = 0;
  for (const Curve& curve : curves) rows += curve.indentation.size();
  for (const FreeParameter& free : options.free) rows += free.prior ? 1 : 0;
  // Without sigma the residuals must also yield their own variance.
  if (rows < options.free.size() + (has_sigma ? 0 : 1))
    found.push_back({"curves", std::to_string(rows) + " forces and priors",
                     "there must be as many as free parameters, one more where sigma is unknown",
                     "measure more points or free fewer parameters"});
  if (!found.empty()) throw meshes::InvalidInput(found);
}

PressResiduals::PressResiduals(const std::vector<Curve>& curves,
                               const std::vector<ForwardModel*>& models,
                               const PressFitOptions& options)
    : curves_(&curves), models_(&models), options_(&options) {
  has_sigma_ = !curves.front().sigma.empty();
  double squares = 0.0;
  for (const Curve& curve : curves) {
    forces_ += Index(curve.force.size());
    for (const double force : curve.force) squares += force * force;
  }
  if (squares > 0.0) force_scale_ = std::sqrt(squares / double(forces_));
  priors_ = std::ranges::count_if(options.free, [](const auto& free) { return bool(free.prior); });
}

double PressResiduals::sigma(const Curve& curve, std::size_t i) const {
  return has_sigma_ ? curve.sigma[i] : force_scale_;
}

const Linearisation& PressResiduals::at(const Eigen::VectorXd& parameters) {
  if (last_parameters_.size() > 0 && last_parameters_ == parameters) return last_;
  Linearisation now{Eigen::VectorXd(forces_ + priors_),
                    Eigen::MatrixXd::Zero(forces_ + priors_, parameters.size())};
  Index row = 0;
  for (std::size_t c = 0; c < curves_->size(); ++c) {
    const Curve& curve = (*curves_)[c];
    const CurveSlopes slopes = (*models_)[c]->evaluate(parameters);
    for (std::size_t i = 0; i < curve.force.size(); ++i, ++row) {
      now.residuals(row) = (slopes.force(Index(i)) - curve.force[i]) / sigma(curve, i);
      now.jacobian.row(row) = slopes.jacobian.row(Index(i)) / sigma(curve, i);
    }
  }
  for (Index j = 0; j < parameters.size(); ++j) {
    const auto& prior = options_->free[std::size_t(j)].prior;
    if (!prior) continue;
    now.residuals(row) = (parameters(j) - prior->mean) / prior->deviation;
    now.jacobian(row++, j) = 1.0 / prior->deviation;
  }
  if (!now.residuals.allFinite() || !now.jacobian.allFinite())
    throw meshes::NotConverged("press fit: the model's forces or slopes are not finite");
  last_parameters_ = parameters;
  last_ = std::move(now);
  return last_;
}

Eigen::VectorXd PressResiduals::weights(const Linearisation& linearisation) const {
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(linearisation.residuals.size());
  const double width = options_->robust_width;
  if (width == 0.0) return weights;
  for (Index i = 0; i < forces_; ++i)
    weights(i) = 1.0 / std::hypot(1.0, linearisation.residuals(i) / width);
  return weights;
}

Linearisation PressResiduals::with_loss(const Linearisation& linearisation) const {
  Linearisation result = linearisation;
  if (options_->robust_width == 0.0) return result;
  const Eigen::VectorXd weight = weights(linearisation);
  for (Index i = 0; i < forces_; ++i) {
    // q² = 2 w² (1/weight - 1) = r² 2 weight/(1 + weight), free of cancellation at small r.
    const double share = std::sqrt(2.0 * weight(i) / (1.0 + weight(i)));
    result.residuals(i) *= share;
    result.jacobian.row(i) *= weight(i) / share;
  }
  return result;
}

std::vector<Eigen::VectorXd> PressResiduals::misfit(const Linearisation& linearisation) const {
  std::vector<Eigen::VectorXd> result;
  Index row = 0;
  for (const Curve& curve : *curves_) {
    Eigen::VectorXd& forces = result.emplace_back(Index(curve.force.size()));
    for (std::size_t i = 0; i < curve.force.size(); ++i)
      forces(Index(i)) = -linearisation.residuals(row++) * sigma(curve, i);
  }
  return result;
}

}  // namespace fingertip::calibration
