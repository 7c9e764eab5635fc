#include "calibration/statistics/curve_residuals.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <string>
#include <thread>

#include "calibration/statistics/fit_coordinates.h"
#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::calibration::inline statistics {

using Eigen::Index;
using meshes::to_text;
using meshes::Violation;

namespace {

void add_values(std::vector<Violation>& found, const Curve& curve, const std::string& key) {
  const auto positive = [](double value) { return std::isfinite(value) && value > 0.0; };
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    const double depth = curve.x[i];
    const bool allowed = curve.is_travel ? std::isfinite(depth) : positive(depth);
    if (!allowed || (!curve.in_time && i > 0 && depth <= curve.x[i - 1])) {
      found.push_back({key + ".x", to_text(depth),
                       curve.is_travel ? "positions must be finite and increasing"
                                       : "abscissae must be finite, positive and increasing",
                       "sort the points and remove those before contact or twice there"});
      break;
    }
  }
  for (const double force : curve.y)
    if (!std::isfinite(force)) {
      found.push_back({key + ".y", to_text(force), "values must be finite", "remove the point"});
      break;
    }
  for (const double sigma : curve.sigma)
    if (!positive(sigma)) {
      found.push_back({key + ".sigma", to_text(sigma),
                       "standard deviations must be finite and positive",
                       "give that of each value, or none at all"});
      break;
    }
}

void add_curves(std::vector<Violation>& found, const std::vector<Curve>& curves) {
  if (curves.empty())
    found.push_back({"curves", "none", "a fit needs at least one curve", "give one"});
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const Curve& curve = curves[c];
    const std::string key = "curves[" + std::to_string(c) + "]";
    const std::size_t points = curve.x.size();
    if (points == 0) found.push_back({key, "empty", "a curve needs points", "give its points"});
    if (curve.y.size() != points)
      found.push_back({key + ".y", std::to_string(curve.y.size()) + " values",
                       "there must be as many values as abscissae", "complete the list"});
    if (!curve.sigma.empty() && curve.sigma.size() != points)
      found.push_back({key + ".sigma", std::to_string(curve.sigma.size()) + " values",
                       "there must be one standard deviation per value, or none",
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

bool within_bounds(const Eigen::VectorXd& start, const CurveFitOptions& options) {
  for (std::size_t i = 0; i < options.free.size(); ++i) {
    const double value = start(Index(i));
    const FreeParameter& free = options.free[i];
    if (!std::isfinite(value) || value < free.lower || value > free.upper) return false;
    if (varies_by_logarithm(free) && value <= 0.0) return false;
  }
  return true;
}

void add_parameters(std::vector<Violation>& found, const CurveFitOptions& options) {
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
  }
}

}  // namespace

void check_curve_fit(const std::vector<Curve>& curves, const CurveFitOptions& options) {
  std::vector<Violation> found;
  add_curves(found, curves);
  const bool has_sigma = !curves.empty() && !curves.front().sigma.empty();
  if (options.free.empty())
    found.push_back({"free", "none", "a fit needs a free parameter", "name at least one"});
  add_parameters(found, options);
  if (!std::isfinite(options.robust_width) || options.robust_width < 0.0 ||
      (options.robust_width > 0.0 && !has_sigma))
    found.push_back({"robust_width", to_text(options.robust_width),
                     "the width must be finite, not negative, and counts in sigma",
                     "give the curves' sigma, or 0"});
  for (const auto* starts : {&options.other_starts, &options.reserve_starts})
    for (const Eigen::VectorXd& start : *starts)
      if (start.size() != Index(options.free.size()) || !within_bounds(start, options))
        found.push_back({"other_starts", std::to_string(start.size()) + " values",
                         "a start has a finite value within its bounds for every free parameter",
                         "complete or move it"});
  std::size_t rows = 0;
  for (const Curve& curve : curves) rows += curve.x.size();
  for (const FreeParameter& free : options.free) rows += free.prior ? 1 : 0;
  // Without sigma the residuals must also yield their own variance.
  if (rows < options.free.size() + (has_sigma ? 0 : 1))
    found.push_back({"curves", std::to_string(rows) + " values and priors",
                     "there must be as many as free parameters, one more where sigma is unknown",
                     "measure more points or free fewer parameters"});
  if (!found.empty()) throw meshes::InvalidInput(found);
}

CurveResiduals::CurveResiduals(const std::vector<Curve>& curves,
                               const std::vector<ForwardModel*>& models,
                               const CurveFitOptions& options)
    : curves_(&curves), models_(&models), options_(&options) {
  has_sigma_ = !curves.front().sigma.empty();
  std::vector<double> sigma;
  for (const Curve& curve : curves)
    sigma.insert(sigma.end(), curve.sigma.begin(), curve.sigma.end());
  measured_ = all_values(curves);
  whiten(measured_, Eigen::Map<const Eigen::VectorXd>(sigma.data(), Index(sigma.size())));
  noise_ = 0.5 * (whitening_ * (1e-10 * measured_)).squaredNorm();
  priors_ = std::ranges::count_if(options.free, [](const auto& free) { return bool(free.prior); });
  if (!has_sigma_ && options.value_deviation > 0.0) weigh_priors(options.value_deviation);
}

void CurveResiduals::weigh_priors(double deviation) {
  const double weight = std::max(deviation * whitening_(0, 0), 1e-12);
  for (Known& known : known_) {
    known.linearisation.residuals.tail(priors_) *= weight / prior_weight_;
    known.linearisation.jacobian.bottomRows(priors_) *= weight / prior_weight_;
  }
  prior_weight_ = weight;
  forget_least();
}

meshes::EigenPairs decomposed_covariance(Eigen::MatrixXd model, const Eigen::VectorXd& deviations) {
  model.diagonal() += deviations.cwiseAbs2();
  return meshes::symmetric_eigen(model);
}

/// The symmetric root, which leaves a residual as much at its own place as there can be: an outlier
/// stays one, and signs keep their order.
void CurveResiduals::whiten(const Eigen::VectorXd& values, const Eigen::VectorXd& sigma) {
  const Index count = values.size();
  Eigen::VectorXd deviations =
      has_sigma_ ? sigma
                 : Eigen::VectorXd::Constant(count, values.norm() / std::sqrt(double(count)));
  if (!(deviations.minCoeff() > 0.0)) deviations.setOnes();  // all values zero, no sigma
  whitening_ = deviations.cwiseInverse().asDiagonal();
  colouring_ = deviations.asDiagonal();
  if (!has_sigma_ || options_->model_covariance.size() == 0) return;
  const auto eigen = decomposed_covariance(options_->model_covariance, deviations);
  whitening_ = eigen.inverse_root();
  colouring_ = eigen.root();
}

double CurveResiduals::loss_of_standard_error(double loss) const {
  const Index freedom = values() + priors_ - parameters();
  const double unit = has_sigma_ ? 0.5 : loss / double(std::max<Index>(freedom, 1));
  return std::max(unit, noise_);
}

std::vector<ForwardModel*> CurveResiduals::distinct_models() const {
  std::vector<ForwardModel*> distinct;
  for (ForwardModel* model : *models_)
    if (std::ranges::find(distinct, model) == distinct.end()) distinct.push_back(model);
  return distinct;
}

void CurveResiduals::side_by_side(std::size_t count,
                                  const std::function<void(std::size_t)>& act) const {
  std::vector<std::exception_ptr> errors(count);
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> failed = false;
  const auto work = [&] {
    for (std::size_t i = next++; i < count && !failed; i = next++) {
      try {
        act(i);
      } catch (...) {
        errors[i] = std::current_exception();
        failed = true;
      }
    }
  };
  {
    std::vector<std::jthread> others;
    for (std::size_t t = 1; t < std::min(std::size_t(options_->threads), count); ++t)
      others.emplace_back(work);
    work();
  }
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
}

std::vector<CurveSlopes> CurveResiduals::evaluate(const Eigen::VectorXd& parameters) const {
  const std::vector<ForwardModel*> distinct = distinct_models();
  std::vector<CurveSlopes> answers(distinct.size());
  side_by_side(distinct.size(),
               [&](std::size_t i) { answers[i] = distinct[i]->evaluate(parameters); });
  std::vector<CurveSlopes> per_curve;
  for (ForwardModel* model : *models_)
    per_curve.push_back(
        answers[std::size_t(std::ranges::find(distinct, model) - distinct.begin())]);
  return per_curve;
}

bool CurveResiduals::refine(const Eigen::VectorXd& parameters) const {
  const std::vector<ForwardModel*> distinct = distinct_models();
  std::atomic<bool> others = false;
  side_by_side(distinct.size(), [&](std::size_t i) {
    if (distinct[i]->refine(parameters)) others = true;
  });
  return others;
}

const Linearisation& CurveResiduals::told(const Known& known) {
  const double loss = 0.5 * with_loss(known.linearisation).residuals.squaredNorm();
  if (loss < min_loss_) least_ = known.parameters, min_loss_ = loss;
  return known.linearisation;
}

const Linearisation& CurveResiduals::at(const Eigen::VectorXd& parameters) {
  const auto same = [&](const Known& known) { return known.parameters == parameters; };
  if (const auto found = std::ranges::find_if(known_, same); found != known_.end())
    return told(*found);
  if (evaluations_ >= allowed_) throw EvaluationsSpent();
  Linearisation now{Eigen::VectorXd(values() + priors_),
                    Eigen::MatrixXd::Zero(values() + priors_, parameters.size())};
  Index row = 0;
  const std::vector<CurveSlopes> answers = evaluate(parameters);
  for (std::size_t c = 0; c < answers.size(); ++c) {
    const CurveSlopes& slopes = answers[c];
    const Index count = Index((*curves_)[c].y.size());
    if (slopes.value.size() != count || slopes.jacobian.rows() != count ||
        slopes.jacobian.cols() != parameters.size())
      throw meshes::InvalidInput({"models[" + std::to_string(c) + "]",
                                  std::to_string(slopes.value.size()) + " values",
                                  "a model answers at its curve's abscissae, by every parameter",
                                  "make it for the curve's x and the free parameters"});
    now.residuals.segment(row, count) = slopes.value;
    now.jacobian.middleRows(row, count) = slopes.jacobian;
    row += count;
  }
  now.residuals.head(row) -= measured_;
  if (has_sigma_ && options_->model_covariance.size() > 0) {
    now.residuals.head(row) = whitening_ * now.residuals.head(row);
    now.jacobian.topRows(row) = whitening_ * now.jacobian.topRows(row);
  } else {  // diagonal, of thousands of values perhaps
    now.residuals.head(row).array() *= whitening_.diagonal().array();
    now.jacobian.topRows(row).array().colwise() *= whitening_.diagonal().array();
  }
  for (Index j = 0; j < parameters.size(); ++j) {
    const auto& prior = options_->free[std::size_t(j)].prior;
    if (!prior) continue;
    now.residuals(row) = prior_weight_ * (parameters(j) - prior->mean) / prior->deviation;
    now.jacobian(row++, j) = prior_weight_ / prior->deviation;
  }
  if (!now.residuals.allFinite() || !now.jacobian.allFinite())
    throw meshes::NotConverged("curve fit: the model's values or slopes are not finite");
  known_.push_front({parameters, std::move(now)});
  ++evaluations_;
  const Linearisation& kept = told(known_.front());
  if (options_->progress &&
      !options_->progress(evaluations_, 0.5 * with_loss(kept).residuals.squaredNorm()))
    throw meshes::Interrupted("the fit was interrupted");
  return kept;
}

Eigen::VectorXd CurveResiduals::weights(const Linearisation& linearisation) const {
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(linearisation.residuals.size());
  const double width = options_->robust_width;
  if (width == 0.0) return weights;
  for (Index i = 0; i < values(); ++i)
    weights(i) = 1.0 / std::hypot(1.0, linearisation.residuals(i) / width);
  return weights;
}

Linearisation CurveResiduals::with_loss(const Linearisation& linearisation) const {
  Linearisation result = linearisation;
  if (options_->robust_width == 0.0) return result;
  const Eigen::VectorXd weight = weights(linearisation);
  for (Index i = 0; i < values(); ++i) {
    // q² = 2 w² (1/weight - 1) = r² 2 weight/(1 + weight), free of cancellation at small r.
    const double share = std::sqrt(2.0 * weight(i) / (1.0 + weight(i)));
    result.residuals(i) *= share;
    result.jacobian.row(i) *= weight(i) / share;
  }
  return result;
}

std::vector<Eigen::VectorXd> CurveResiduals::by_curve(const Eigen::VectorXd& all) const {
  std::vector<Eigen::VectorXd> result;
  for (std::size_t i = 0; i < curves_->size(); ++i)
    result.push_back(all.segment(first_value(*curves_, i), Index((*curves_)[i].y.size())));
  return result;
}

std::vector<Eigen::VectorXd> CurveResiduals::misfit(const Linearisation& linearisation) const {
  return by_curve(-(colouring_ * linearisation.residuals.head(values())));
}

std::vector<Eigen::VectorXd> CurveResiduals::whitened_misfit(
    const Linearisation& linearisation) const {
  return by_curve(-linearisation.residuals.head(values()));
}

}  // namespace fingertip::calibration::inline statistics
