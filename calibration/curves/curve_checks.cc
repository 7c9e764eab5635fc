#include "calibration/curves/curve_checks.h"

#include <algorithm>
#include <cmath>

#include "calibration/curves/curve_residuals.h"
#include "calibration/curves/fit_coordinates.h"
#include "meshes/errors.h"
#include "meshes/files.h"

namespace fingertip::calibration {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// The same fit, from `estimates` alone.
CurveFitOptions warm_started(CurveFitOptions options, const VectorXd& estimates) {
  options.other_starts.clear();
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

LeftOut leave_out(const std::vector<Curve>& curves, const std::vector<ForwardModel*>& models,
                  const CurveFitOptions& options, std::size_t place) {
  LeftOut result;
  try {
    const CurveFit fit = fit_curves(without(curves, place), without(models, place), options);
    const VectorXd predicted = models[place]->evaluate(fit.estimates).value;
    const auto& y = curves[place].y;
    result.residuals = Eigen::Map<const VectorXd>(y.data(), Index(y.size())) - predicted;
    result.estimates = fit.estimates;
  } catch (const meshes::InvalidInput& error) {
    result.failure = error.what();
  } catch (const meshes::NotConverged& error) {
    result.failure = error.what();
  }
  for (Index i = 0; i < result.residuals.size(); ++i) {
    const double measured = curves[place].y[std::size_t(i)];
    if (measured != 0.0)
      result.worst_relative_error =
          std::max(result.worst_relative_error, std::abs(result.residuals(i) / measured));
  }
  return result;
}

/// sum f y / sum f² of the model's values f and the measured y over their deviations; none where
/// the model has no answer or no values.
double best_scale(CurveResiduals& residuals, const std::vector<Curve>& curves,
                  const VectorXd& parameters) {
  const Linearisation& at = residuals.at(parameters);
  std::vector<double> measured;
  for (const Curve& curve : curves) measured.insert(measured.end(), curve.y.begin(), curve.y.end());
  const VectorXd y = Eigen::Map<const VectorXd>(measured.data(), residuals.values())
                         .cwiseQuotient(residuals.deviations());
  const VectorXd f = at.residuals.head(residuals.values()) + y;
  return f.dot(y) / f.squaredNorm();
}

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

Eigen::MatrixXd influence(const CurveFit& fit) {
  return fit.covariance * fit.jacobian.transpose() * fit.deviations.cwiseInverse().asDiagonal();
}

std::vector<VectorXd> scaled_starts(const std::vector<Curve>& curves,
                                    const std::vector<ForwardModel*>& models,
                                    const CurveFitOptions& options,
                                    const std::vector<double>& poissons_ratios) {
  check_curve_fit(curves, options);
  check_ratios(options, poissons_ratios);
  const auto [e, g] = *places_of_moduli(options);
  CurveResiduals residuals(curves, models, options);
  std::vector<VectorXd> starts;
  for (const double nu : poissons_ratios) {
    VectorXd start(Index(options.free.size()));
    for (Index i = 0; i < start.size(); ++i) start(i) = options.free[std::size_t(i)].start;
    start(e) = 2.0 * (1.0 + nu) * start(g);
    try {
      const double scale = best_scale(residuals, curves, start);
      if (!(scale > 0.0) || !std::isfinite(scale)) continue;
      for (const Index i : {e, g}) {
        const FreeParameter& free = options.free[std::size_t(i)];
        start(i) = std::clamp(scale * start(i), free.lower, free.upper);
      }
      starts.push_back(start);
    } catch (const meshes::NotConverged&) {
      continue;
    }
  }
  return starts;
}

}  // namespace fingertip::calibration
