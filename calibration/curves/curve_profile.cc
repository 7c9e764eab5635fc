#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "calibration/curves/curve_checks.h"
#include "calibration/curves/curve_minimum.h"
#include "calibration/curves/curve_residuals.h"
#include "calibration/curves/fit_coordinates.h"
#include "meshes/errors.h"

namespace fingertip::calibration {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// `model` with two parameters held.
class HeldModel final : public ForwardModel {
 public:
  HeldModel(ForwardModel& model, const VectorXd& all, const std::vector<Index>& others)
      : model_(model), all_(all), others_(others) {}

  CurveSlopes evaluate(const VectorXd& parameters) override {
    VectorXd p = all_;
    p(others_) = parameters;
    CurveSlopes result = model_.evaluate(p);
    const Eigen::MatrixXd columns = result.jacobian(Eigen::indexing::all, others_);
    result.jacobian = columns;
    return result;
  }

 private:
  ForwardModel& model_;
  const VectorXd& all_;
  const std::vector<Index>& others_;
};

VectorXd grid_of(const FreeParameter& free, double estimate, double error,
                 const ProfileOptions& profile) {
  const double positive = varies_by_logarithm(free) ? 0.1 * estimate : lower_bound(free);
  const double from = std::max({estimate - profile.half_width * error, free.lower, positive});
  return VectorXd::LinSpaced(profile.points, from,
                             std::min(estimate + profile.half_width * error, free.upper));
}

/// The loss's valley, seen from two of its parameters.
class Valley {
 public:
  Valley(const std::vector<Curve>& curves, const std::vector<ForwardModel*>& models,
         const CurveFitOptions& options, const CurveFit& fit, Index first, Index second)
      : curves_(curves),
        options_(options),
        fit_(fit),
        first_(first),
        second_(second),
        full_(curves, models, options),
        at_(fit.estimates) {
    for (Index i = 0; i < at_.size(); ++i)
      if (i != first && i != second) others_.push_back(i);
    // A model of several curves stays one: it must not be evaluated side by side with itself.
    for (ForwardModel* model : models) {
      const auto held = held_.try_emplace(model, *model, at_, others_).first;
      addresses_.push_back(&held->second);
    }
    least_ = loss(at_);
  }

  /// Of the loss over that at the estimates; NaN where a model has no answer.
  double increase(double first, double second) {
    try {
      set(first, second);
      if (!others_.empty()) refit();
      return loss(at_) - least_;
    } catch (const meshes::InvalidInput&) {
      return std::numeric_limits<double>::quiet_NaN();
    } catch (const meshes::NotConverged&) {
      return std::numeric_limits<double>::quiet_NaN();
    }
  }

 private:
  double loss(const VectorXd& parameters) {
    return 0.5 * full_.with_loss(full_.at(parameters)).residuals.squaredNorm();
  }

  /// Holds the two; the others go where the covariance expects them, within their bounds.
  void set(double first, double second) {
    const std::vector<Index> profiled = {first_, second_};
    const Eigen::Vector2d step(first - fit_.estimates(first_), second - fit_.estimates(second_));
    const Eigen::Matrix2d own = fit_.covariance(profiled, profiled);
    const Eigen::MatrixXd cross = fit_.covariance(others_, profiled);
    at_ = fit_.estimates;
    const VectorXd shift = cross * own.fullPivLu().solve(step);
    for (std::size_t k = 0; k < others_.size(); ++k) {
      const Index i = others_[k];
      const FreeParameter& free = options_.free[std::size_t(i)];
      const double low = varies_by_logarithm(free) ? 0.1 * at_(i) : lower_bound(free);
      at_(i) = std::clamp(at_(i) + shift(Index(k)), std::max(low, free.lower), free.upper);
    }
    at_(first_) = first;
    at_(second_) = second;
  }

  void refit() {
    CurveFitOptions options = options_;
    options.free.clear();
    VectorXd start(Index(others_.size()));
    for (std::size_t k = 0; k < others_.size(); ++k) {
      const Index i = others_[k];
      options.free.push_back(options_.free[std::size_t(i)]);
      options.free.back().scale = size_of(options.free.back());
      start(Index(k)) = at_(i);
    }
    CurveResiduals residuals(curves_, addresses_, options);
    at_(others_) = minimise(residuals, options, start).estimates;
  }

  const std::vector<Curve>& curves_;
  const CurveFitOptions& options_;
  const CurveFit& fit_;
  const Index first_, second_;
  CurveResiduals full_;
  VectorXd at_;
  std::vector<Index> others_;
  std::map<ForwardModel*, HeldModel> held_;
  std::vector<ForwardModel*> addresses_;  ///< of the curves' models in held_
  double least_ = 0.0;
};

void check(const CurveFitOptions& options, std::size_t first, std::size_t second,
           const ProfileOptions& profile) {
  std::vector<meshes::Violation> found;
  if (first == second || std::max(first, second) >= options.free.size())
    found.push_back({"profile", std::to_string(first) + ", " + std::to_string(second),
                     "a profile is over two different free parameters", "name two of them"});
  if (profile.points < 2 || !(profile.half_width > 0.0) || !std::isfinite(profile.half_width))
    found.push_back({"profile.points", std::to_string(profile.points),
                     "a profile has two points or more and a positive width", "change them"});
  if (!found.empty()) throw meshes::InvalidInput(found);
}

}  // namespace

Profile profile_likelihood(const std::vector<Curve>& curves,
                           const std::vector<ForwardModel*>& models, const CurveFitOptions& options,
                           const CurveFit& fit, std::size_t first, std::size_t second,
                           const ProfileOptions& profile) {
  check_curve_fit(curves, options);
  check(options, first, second, profile);
  const auto grid = [&](std::size_t i) {
    return grid_of(options.free[i], fit.estimates(Index(i)), fit.standard_errors(Index(i)),
                   profile);
  };
  Profile result{grid(first), grid(second), Eigen::MatrixXd(profile.points, profile.points)};
  Valley valley(curves, models, options, fit, Index(first), Index(second));
  double unit = 0.5;
  if (curves.front().sigma.empty()) {
    // Losses are in units of the values' root mean square, not of the residuals' deviation.
    const CurveResiduals residuals(curves, models, options);
    unit *= std::pow(std::max(fit.residual_deviation * residuals.whitening()(0, 0), 1e-150), 2);
  }
  for (Index i = 0; i < profile.points; ++i)
    for (Index j = 0; j < profile.points; ++j)
      result.increase(i, j) =
          valley.increase(result.first_values(i), result.second_values(j)) / unit;
  return result;
}

}  // namespace fingertip::calibration
