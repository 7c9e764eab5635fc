#include "calibration/statistics/curve_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "calibration/files/words.h"
#include "calibration/statistics/curve_residuals.h"
#include "calibration/statistics/fit_coordinates.h"
#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::calibration::inline statistics {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// The same fit, from `estimates` alone.
CurveFitOptions warm_started(CurveFitOptions options, const VectorXd& estimates) {
  options.start_once();
  for (std::size_t i = 0; i < options.free.size(); ++i) {
    FreeParameter& free = options.free[i];
    free.scale = size_of(free);
    free.start = std::clamp(estimates(Index(i)), free.lower, free.upper);
  }
  return options;
}

template <typename T>
std::vector<T> without(std::vector<T> list, std::size_t place) {
  list.erase(list.begin() + Index(place));
  return list;
}

/// The errors of the models that answer for the other curves.
CurveFitOptions without_values(CurveFitOptions options, const std::vector<Curve>& curves,
                               std::size_t place) {
  if (options.model_covariance.size() == 0) return options;
  std::vector<Index> kept;
  Index row = 0;
  for (std::size_t c = 0; c < curves.size(); ++c)
    for (std::size_t i = 0; i < curves[c].y.size(); ++i, ++row)
      if (c != place) kept.push_back(row);
  options.model_covariance = Eigen::MatrixXd(options.model_covariance(kept, kept));
  return options;
}

LeftOut leave_out(const std::vector<Curve>& curves, const std::vector<ForwardModel*>& models,
                  const CurveFitOptions& options, std::size_t place) {
  LeftOut result;
  try {
    const CurveFit fit = fit_curves(without(curves, place), without(models, place),
                                    without_values(options, curves, place));
    if (!fit.converged) throw meshes::NotConverged("no minimum within the evaluations allowed");
    const VectorXd predicted = models[place]->evaluate(fit.estimates).value;
    result.residuals = values_of(curves[place]) - predicted;
    result.estimates = fit.estimates;
  } catch (const meshes::InvalidInput& error) {
    result.failure = error.what();
  } catch (const meshes::NotConverged& error) {
    result.failure = error.what();
  }
  if (result.failure.empty())
    result.worst_relative_error = worst_relative_error(result.residuals, curves[place]);
  return result;
}

/// The model's values over their deviations.
VectorXd whitened_values(CurveResiduals& residuals, const std::vector<Curve>& curves,
                         const VectorXd& parameters) {
  return residuals.at(parameters).residuals.head(residuals.values()) +
         residuals.whitening() * all_values(curves);
}

/// sum f y / sum f² of the model's values f and the measured y over their deviations; none where
/// there is no positive factor.
std::optional<double> best_scale(CurveResiduals& residuals, const std::vector<Curve>& curves,
                                 const VectorXd& parameters) {
  const VectorXd f = whitened_values(residuals, curves, parameters);
  const VectorXd y = f - residuals.at(parameters).residuals.head(residuals.values());
  const double scale = f.dot(y) / f.squaredNorm();
  return scale > 0.0 && std::isfinite(scale) ? std::optional(scale) : std::nullopt;
}

bool is_stiffness(const FreeParameter& free) {
  return unit(free.parameter) == "Pa" || unit(free.parameter) == "N/m";
}

/// Moduli times `scale`, within their bounds.
void rescale(VectorXd& parameters, const CurveFitOptions& options, double scale) {
  for (std::size_t i = 0; i < options.free.size(); ++i) {
    const FreeParameter& free = options.free[i];
    if (is_stiffness(free))
      parameters(Index(i)) = std::clamp(scale * parameters(Index(i)), free.lower, free.upper);
  }
}

struct ScannedStart {
  VectorXd parameters;
  double loss = 0.0;
};

void check_ratios(const CurveFitOptions& options, const std::vector<double>& ratios) {
  if (!places_of_moduli(options))
    throw meshes::InvalidInput({"free", "without E or G",
                                "starts are scaled in E and G, which must both be free",
                                "free both, or give starts"});
  for (const double nu : ratios)
    if (!(nu > -1.0 && nu < 0.5))
      throw meshes::InvalidInput({"poissons_ratios", meshes::to_text(nu),
                                  "Poisson's ratio lies between -1 and 1/2", "change it"});
}

}  // namespace

double worst_relative_error(const VectorXd& residuals, const Curve& curve) {
  // Before touch a travel's forces are noise about zero.
  const double largest = values_of(curve).cwiseAbs().maxCoeff();
  double worst = 0.0;
  for (Index i = 0; i < residuals.size(); ++i) {
    const double base = curve.is_travel ? largest : std::abs(curve.y[std::size_t(i)]);
    if (base != 0.0) worst = std::max(worst, std::abs(residuals(i)) / base);
  }
  return worst;
}

double relative_rms(const VectorXd& residuals, const VectorXd& values) {
  const double size = values.norm();
  return size > 0.0 ? residuals.norm() / size : std::numeric_limits<double>::quiet_NaN();
}

std::optional<std::string> missed(const std::string& model, const std::string& name,
                                  const VectorXd& residuals, const VectorXd& values, double most) {
  const double share = relative_rms(residuals, values);
  if (!(share > most)) return std::nullopt;
  return model + " does not describe the data: " + name + " is missed by " + percent(share) + " (" +
         std::string(name_of_relative_rms) + ")";
}

std::vector<LeftOut> leave_one_out(const std::vector<Curve>& curves,
                                   const std::vector<ForwardModel*>& models,
                                   const CurveFitOptions& options, const CurveFit& fit) {
  if (curves.size() < 2)
    throw meshes::InvalidInput({"curves", std::to_string(curves.size()),
                                "a curve can be left out where another remains",
                                "give two or more"});
  const CurveFitOptions warm = warm_started(options, fit.estimates);
  std::vector<LeftOut> results;
  for (std::size_t c = 0; c < curves.size(); ++c)
    results.push_back(leave_out(curves, models, warm, c));
  return results;
}

ScaledStarts scaled_starts(const std::vector<Curve>& curves,
                           const std::vector<ForwardModel*>& models, const CurveFitOptions& options,
                           std::vector<double> poissons_ratios) {
  check_curve_fit(curves, options);
  check_ratios(options, poissons_ratios);
  const auto [e, g] = *places_of_moduli(options);
  CurveResiduals residuals(curves, models, options);
  std::ranges::sort(poissons_ratios);
  std::vector<ScannedStart> scan;
  for (const double nu : poissons_ratios) {
    VectorXd start = start_of(options);
    start(e) = 2.0 * (1.0 + nu) * start(g);
    try {
      const auto scale = best_scale(residuals, curves, start);
      if (!scale) continue;
      rescale(start, options, *scale);
      scan.push_back(
          {start, 0.5 * residuals.with_loss(residuals.at(start)).residuals.squaredNorm()});
    } catch (const meshes::NotConverged&) {
      continue;
    }
  }
  std::vector<ScannedStart> valleys, others;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const bool valley = (i == 0 || scan[i].loss < scan[i - 1].loss) &&
                        (i + 1 == scan.size() || scan[i].loss <= scan[i + 1].loss);
    (valley ? valleys : others).push_back(scan[i]);
  }
  const auto by_loss = [](std::vector<ScannedStart>& starts) {
    std::ranges::stable_sort(starts, {}, &ScannedStart::loss);
    std::vector<VectorXd> sorted;
    for (const ScannedStart& start : starts) sorted.push_back(start.parameters);
    return sorted;
  };
  return {by_loss(valleys), by_loss(others)};
}

std::optional<VectorXd> scaled_start(const std::vector<Curve>& curves,
                                     const std::vector<ForwardModel*>& models,
                                     const CurveFitOptions& options) {
  check_curve_fit(curves, options);
  CurveResiduals residuals(curves, models, options);
  VectorXd start = start_of(options), stiffness = VectorXd::Zero(start.size());
  for (Index i = 0; i < start.size(); ++i)
    if (is_stiffness(options.free[std::size_t(i)])) stiffness(i) = start(i);
  const VectorXd values = whitened_values(residuals, curves, start);
  const VectorXd sum =
      residuals.at(start).jacobian.topRows(residuals.values()) * stiffness - values;
  if (!(sum.norm() <= 1e-6 * values.norm())) return std::nullopt;
  const auto scale = best_scale(residuals, curves, start);
  if (scale) rescale(start, options, *scale);
  return scale ? std::optional(start) : std::nullopt;
}

}  // namespace fingertip::calibration::inline statistics
