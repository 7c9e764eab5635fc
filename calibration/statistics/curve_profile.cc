#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "calibration/statistics/curve_checks.h"
#include "calibration/statistics/curve_minimum.h"
#include "calibration/statistics/curve_residuals.h"
#include "calibration/statistics/fit_coordinates.h"
#include "meshes/base/errors.h"

namespace fingertip::calibration::inline statistics {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// `model` with some parameters held.
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

VectorXd grid_of(const FreeParameter& free, double estimate, double error, int points) {
  constexpr double half_width = 3.0;  // in standard errors
  const double positive = varies_by_logarithm(free) ? 0.1 * estimate : lower_bound(free);
  return VectorXd::LinSpaced(points,
                             std::max({estimate - half_width * error, free.lower, positive}),
                             std::min(estimate + half_width * error, free.upper));
}

/// The loss's valley, seen from one or two of its parameters.
class Valley {
 public:
  Valley(const std::vector<Curve>& curves, const std::vector<ForwardModel*>& models,
         const CurveFitOptions& options, const CurveFit& fit, std::vector<Index> profiled)
      : curves_(curves),
        options_(weighed(options, fit)),
        fit_(fit),
        profiled_(std::move(profiled)),
        full_(curves, models, options_),
        at_(fit.estimates) {
    for (Index i = 0; i < at_.size(); ++i)
      if (std::ranges::find(profiled_, i) == profiled_.end()) others_.push_back(i);
    // A model of several curves stays one: it must not be evaluated side by side with itself.
    for (ForwardModel* model : models) {
      const auto held = held_.try_emplace(model, *model, at_, others_).first;
      addresses_.push_back(&held->second);
    }
    least_ = loss(at_);
    // Losses are in units of the values' root mean square, not of the residuals' deviation.
    if (!full_.has_sigma())
      unit_ *= std::pow(std::max(fit.residual_deviation * full_.whitening()(0, 0), 1e-150), 2);
  }

  /// Of twice the loss over that at the estimates, in units of sigma or of the residual deviation;
  /// NaN where a model has no answer.
  double increase(const VectorXd& values) {
    try {
      set(values);
      if (!others_.empty()) refit();
      return (loss(at_) - least_) / unit_;
    } catch (const meshes::InvalidInput&) {
      return std::numeric_limits<double>::quiet_NaN();
    } catch (const meshes::NotConverged&) {
      return std::numeric_limits<double>::quiet_NaN();
    }
  }

 private:
  static CurveFitOptions weighed(CurveFitOptions options, const CurveFit& fit) {
    options.value_deviation = fit.residual_deviation;
    return options;
  }
  double loss(const VectorXd& parameters) {
    return 0.5 * full_.with_loss(full_.at(parameters)).residuals.squaredNorm();
  }

  /// Holds them; the others go where the covariance expects them, within their bounds.
  void set(const VectorXd& values) {
    const VectorXd step = values - fit_.estimates(profiled_);
    const Eigen::MatrixXd own = fit_.covariance(profiled_, profiled_);
    const Eigen::MatrixXd cross = fit_.covariance(others_, profiled_);
    at_ = fit_.estimates;
    const VectorXd shift = cross * own.fullPivLu().solve(step);
    for (std::size_t k = 0; k < others_.size(); ++k) {
      const Index i = others_[k];
      const FreeParameter& free = options_.free[std::size_t(i)];
      const double low = varies_by_logarithm(free) ? 0.1 * at_(i) : lower_bound(free);
      at_(i) = std::clamp(at_(i) + shift(Index(k)), std::max(low, free.lower), free.upper);
    }
    at_(profiled_) = values;
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
  const CurveFitOptions options_;
  const CurveFit& fit_;
  const std::vector<Index> profiled_;
  CurveResiduals full_;
  VectorXd at_;
  std::vector<Index> others_;
  std::map<ForwardModel*, HeldModel> held_;
  std::vector<ForwardModel*> addresses_;  ///< of the curves' models in held_
  double least_ = 0.0;
  double unit_ = 0.5;  ///< the loss of a standard error
};

}  // namespace

Profile profile_likelihood(const std::vector<Curve>& curves,
                           const std::vector<ForwardModel*>& models, const CurveFitOptions& options,
                           const CurveFit& fit, std::size_t first, std::size_t second, int points) {
  check_curve_fit(curves, options);
  if (first == second || std::max(first, second) >= options.free.size())
    throw meshes::InvalidInput({"profile", std::to_string(first) + ", " + std::to_string(second),
                                "a profile is over two different free parameters",
                                "name two of them"});
  const auto grid = [&](std::size_t i) {
    return grid_of(options.free[i], fit.estimates(Index(i)), fit.standard_errors(Index(i)), points);
  };
  Profile result{grid(first), grid(second), Eigen::MatrixXd(points, points)};
  Valley valley(curves, models, options, fit, {Index(first), Index(second)});
  for (Index i = 0; i < points; ++i)
    for (Index j = 0; j < points; ++j)
      result.increase(i, j) =
          valley.increase(Eigen::Vector2d(result.first_values(i), result.second_values(j)));
  return result;
}

namespace {

/// Ends beyond so many standard errors count as open; an end is found to `close` of one.
constexpr double farthest = 30.0, close_enough = 1e-3;

/// The step in standard errors, of that sign, at which the root of the increase is `width`.
double crossing(Valley& valley, double estimate, double error, double sign, double limit,
                double width) {
  const auto excess = [&](double step) {
    const double increase = valley.increase(VectorXd::Constant(1, estimate + sign * step * error));
    return std::sqrt(std::max(0.0, increase)) - width;  // NaN stays
  };
  double low = 0.0, at_low = -width, high = std::min(width, limit), at_high = excess(high);
  while (at_high < 0.0) {
    if (high >= limit) return std::numeric_limits<double>::quiet_NaN();
    low = high;
    at_low = at_high;
    high = std::min(1.6 * high, limit);
    at_high = excess(high);
  }
  // False position, each time toward the end that stays (Illinois).
  for (int i = 0; i < 60 && std::isfinite(at_high) && high - low > close_enough; ++i) {
    const double next = std::clamp((low * at_high - high * at_low) / (at_high - at_low),
                                   low + 0.25 * close_enough, high - 0.25 * close_enough);
    const double at_next = excess(next);
    if (at_next < 0.0) {
      low = next;
      at_low = at_next;
      at_high *= 0.5;
    } else {
      high = next;
      at_high = at_next;
      at_low *= 0.5;
    }
  }
  return std::isfinite(at_high) ? 0.5 * (low + high) : at_high;
}

/// Where sigma is not given the models' errors are no part of the loss but come through it.
double error_through_models(const std::vector<Curve>& curves, const CurveFitOptions& options,
                            const CurveFit& fit, Index i) {
  if (!curves.front().sigma.empty() || options.model_covariance.size() == 0) return 0.0;
  const Eigen::RowVectorXd row = fit.influence.row(i);
  return std::sqrt(std::max(0.0, (row * options.model_covariance * row.transpose()).value()));
}

}  // namespace

ProfileInterval profile_interval(const std::vector<Curve>& curves,
                                 const std::vector<ForwardModel*>& models,
                                 const CurveFitOptions& options, const CurveFit& fit,
                                 std::size_t place, double half_width) {
  check_curve_fit(curves, options);
  if (place >= options.free.size() || !(half_width > 0.0) || !std::isfinite(half_width))
    throw meshes::InvalidInput({"profile", std::to_string(place),
                                "an interval is of a free parameter and has a positive width",
                                "name one of them"});
  const Index i = Index(place);
  const FreeParameter& free = options.free[place];
  const double estimate = fit.estimates(i), error = fit.standard_errors(i);
  Valley valley(curves, models, options, fit, {i});
  // What varies by its logarithm is positive.
  const double lowest = varies_by_logarithm(free) ? 1e-3 * estimate : lower_bound(free);
  const double down = std::min(farthest, (estimate - std::max(lowest, free.lower)) / error),
               up = std::min(farthest, (free.upper - estimate) / error);
  const double through_models = half_width * error_through_models(curves, options, fit, i);
  const auto end = [&](double sign, double reach) {
    const double own = error * crossing(valley, estimate, error, sign, reach, half_width);
    return estimate + sign * std::hypot(own, through_models);
  };
  return {end(-1.0, down), end(1.0, up)};
}

}  // namespace fingertip::calibration::inline statistics
