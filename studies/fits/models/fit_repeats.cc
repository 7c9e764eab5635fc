#include "studies/fits/models/fit_repeats.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "calibration/statistics/curve_fit.h"
#include "calibration/statistics/fit_statistics.h"
#include "lattice/press/setup_fields.h"
#include "meshes/press/fields.h"
#include "meshes/tables/fields_json.h"
#include "studies/fits/models/fit_rig.h"

namespace fingertip::studies::inline fits::inline models {

namespace {

/// What repeats have in common.
std::string press_of(const FitCurve& curve) {
  // An indentation's machine is its own (fit_measured.cc), the press may be the same.
  return meshes::json_of(curve.press.geometry).dump() + "|" + curve.condition + "|" +
         (curve.is_travel && curve.travel ? curve.travel->machine : "");
}

/// What the load cell tells without load, at every value of every curve [N].
std::vector<Eigen::VectorXd> zeros(const FitInput& input, const Eigen::VectorXd& estimates) {
  std::vector<Eigen::VectorXd> all;
  for (const FitCurve& curve : input.curves) {
    Eigen::VectorXd& zero = all.emplace_back(Eigen::VectorXd::Zero(Eigen::Index(curve.x.size())));
    if (!curve.travel) continue;
    const calibration::Rig& rig = curve.travel->rig;
    zero.array() += rig.force_offset.in(estimates);
    for (std::size_t k = 0; k < curve.time.size(); ++k)
      zero(Eigen::Index(k)) += rig.drift.in(estimates)*curve.time[k];
  }
  return all;
}

}  // namespace

std::vector<std::vector<std::size_t>> alike(const FitInput& input) {
  std::map<std::string, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < input.curves.size(); ++i)
    if (const CurveKind kind = input.curves[i].kind;
        kind == CurveKind::press || kind == CurveKind::continuum)
      groups[press_of(input.curves[i])].push_back(i);
  std::vector<std::vector<std::size_t>> curves;
  for (auto& [press, group] : groups) curves.push_back(std::move(group));
  return curves;
}

void share_depths(FitInput& input) {
  for (const auto& curves : alike(input)) {
    const auto reach = [&](std::size_t i) { return input.curves[i].travel->depths.back(); };
    const std::vector<double> depths =
        input.curves[*std::ranges::max_element(curves, {}, reach)].travel->depths;
    for (const std::size_t i : curves) {
      FitCurve& curve = input.curves[i];
      curve.travel->depths = curve.press.protocol.samples = depths;
      curve.press.protocol.depth = depths.back();
      curve.continuum.press_to(depths);
    }
  }
}

bool scatter(const std::vector<calibration::Repeats>& repeats) {
  return std::ranges::any_of(
      repeats, [](const calibration::Repeats& group) { return group.deviation > 0.0; });
}

namespace {

using calibration::Curve, calibration::CurveFit, calibration::Repeats;
using Eigen::Index, Eigen::MatrixXd;

/// Of groups of two curves or more.
std::vector<calibration::Repeats> repeats_in(const FitInput& input,
                                             const calibration::CurveFit& fit) {
  std::vector<std::size_t> nuisance;
  for (std::size_t k = 0; k < input.options.free.size(); ++k)
    if (calibration::is_of_the_rig(input.options.free[k].parameter)) nuisance.push_back(k);
  std::vector<calibration::FitQuantity> touch;
  for (const FitCurve& curve : input.curves)
    touch.push_back(curve.travel ? curve.travel->rig.touch_offset : calibration::FitQuantity());
  const std::vector<Curve> all = curves_of(input);
  const auto zero = zeros(input, fit.estimates);
  std::vector<calibration::Repeats> found;
  for (const auto& curves : alike(input))
    if (curves.size() > 1)
      found.push_back(calibration::repeats_of(curves, all, fit, nuisance, touch, zero));
  return found;
}

/// What repeats leave, each with its own factor.
calibration::CurveFit fit_apart(const FitInput& input, const calibration::CurveFit& fit,
                                const std::vector<calibration::Repeats>& repeats) {
  return calibration::apart(fit, repeats, curves_of(input), zeros(input, fit.estimates));
}

/// From where `before` ended, with that covariance.
CurveFit fit_again(const FitInput& input, const std::vector<calibration::ForwardModel*>& models,
                   const std::vector<Curve>& curves, const CurveFit& before,
                   const MatrixXd& covariance) {
  calibration::CurveFitOptions options = input.options;
  options.model_covariance = covariance;
  options.start_once();
  for (std::size_t i = 0; i < options.free.size(); ++i)
    options.free[i].start = before.estimates(Index(i));
  CurveFit fit = calibration::fit_curves(curves, models, options);
  fit.evaluations += before.evaluations;
  return fit;
}

std::vector<Curve> with_sigma(std::vector<Curve> curves, double sigma) {
  for (Curve& curve : curves) curve.sigma.assign(curve.y.size(), sigma);
  return curves;
}

/// Whitened otherwise: by the values' own errors alone, without the scatter.
void whiten_by(CurveFit& fit, const MatrixXd& whitening) {
  fit.jacobian = whitening * fit.whitening.partialPivLu().solve(fit.jacobian);
  fit.whitening = whitening;
}

/// The variance between repeats is known from as many as there are, and with it that of what the
/// repeats tell together, the rubber (Hartung & Knapp, Statistics in Medicine 20, 3875, 2001): of
/// rig quantities, which each repeat tells for itself, it is a part of the variance.
void widen(CurveFit& fit, const std::vector<Repeats>& repeats, const MatrixXd& scattered) {
  int freedom = 0;
  for (const Repeats& group : repeats)
    if (group.deviation > 0.0) freedom += int(group.curves.size()) - 1;
  const MatrixXd between = fit.influence * scattered * fit.influence.transpose();
  const double few = calibration::student_95(freedom),
               many = calibration::normal_95() * fit.birge_ratio;
  for (Index i = 0; i < fit.estimates.size(); ++i) {
    const double all = fit.covariance(i, i), of_repeats = std::min(between(i, i), all);
    const double half =
        calibration::is_of_the_rig(fit.parameters[std::size_t(i)])
            ? std::hypot(many * std::sqrt(all - of_repeats), few * std::sqrt(of_repeats))
            : std::max(few, many) * std::sqrt(all);
    fit.lower(i) = fit.estimates(i) - half;
    fit.upper(i) = fit.estimates(i) + half;
  }
}

/// The fit once more, from where it ended, the scatter in the covariance of all values
/// (input.options.model_covariance): every repeat has a factor on its force, which no touch has to
/// take up, and what is found is that of their mean. `repeats` are sought again until they stay;
/// without sigma the values are weighed by what each repeat leaves of itself. Intervals of the
/// rubber are Student's of the number of repeats, of rigs the part that repeats make.
CurveFit fit_with_scatter(FitInput& input, const std::vector<calibration::ForwardModel*>& models,
                          const CurveFit& first, std::vector<Repeats>& repeats) {
  constexpr int rounds = 8;
  constexpr double close = 0.01;  // of a standard error
  const std::vector<Curve> curves = curves_of(input);
  const bool known = !curves.front().sigma.empty();
  MatrixXd& covariance = input.options.model_covariance;
  const MatrixXd base = covariance;
  CurveFit fit = first;
  MatrixXd scattered;
  for (int round = 0; round < rounds; ++round) {
    const CurveFit before = fit;
    scattered = calibration::covariance_of(repeats, curves, fit, zeros(input, fit.estimates));
    covariance = base.size() == 0 ? scattered : MatrixXd(base + scattered);
    MatrixXd own = first.whitening;
    if (!known) {
      const double deviation = std::max(1.0 / fit_apart(input, fit, repeats).whitening(0, 0),
                                        1e-9 * fit.residual_deviation);
      own = MatrixXd::Identity(own.rows(), own.cols()) / deviation;
      fit = fit_again(input, models, with_sigma(curves, deviation), fit, covariance);
    } else {
      fit = fit_again(input, models, curves, fit, covariance);
    }
    CurveFit plain = fit;
    whiten_by(plain, own);
    if (!known) {
      // As a fit without sigma is, whose chi-square tells nothing.
      plain.whitened_residuals.clear();
      plain.chi_square.reset(), plain.chi_square_probability.reset();
      plain.birge_ratio = 1.0;
      fit = plain;
    }
    const std::vector<Repeats> again = repeats_in(input, plain);
    if (!scatter(again)) break;
    repeats = again;
    const Eigen::VectorXd step = (fit.estimates - before.estimates).cwiseAbs();
    if ((step.array() <= close * fit.standard_errors.array()).all()) break;
  }
  widen(fit, repeats, scattered);
  return fit;
}

/// Intervals up to where chi-square has risen, in place of those of the covariance where both ends
/// are found.
void add_intervals(const std::vector<calibration::ForwardModel*>& models,
                   calibration::FitRecord& record) {
  calibration::CurveFit& fit = record.fit;
  record.profiled.assign(fit.labels.size(), false);
  for (std::size_t i = 0; i < fit.labels.size(); ++i) {
    if (fit.at_bound[i] || !(fit.standard_errors(Eigen::Index(i)) > 0.0)) continue;
    const double half_width = 0.5 * (fit.upper(Eigen::Index(i)) - fit.lower(Eigen::Index(i))) /
                              fit.standard_errors(Eigen::Index(i));
    const auto own =
        calibration::profile_interval(record.curves, models, record.options, fit, i, half_width);
    if (!std::isfinite(own.lower) || !std::isfinite(own.upper)) continue;
    fit.lower(Eigen::Index(i)) = own.lower;
    fit.upper(Eigen::Index(i)) = own.upper;
    record.profiled[i] = true;
  }
}

}  // namespace

CurveFit add_scatter_and_intervals(FitInput& input,
                                   const std::vector<calibration::ForwardModel*>& models,
                                   calibration::FitRecord& record) {
  record.repeats = repeats_in(input, record.fit);
  const bool scattered = scatter(record.repeats);
  CurveFit own = record.fit;
  if (scattered) {
    record.fit = fit_with_scatter(input, models, record.fit, record.repeats);
    record.model_error +=
        std::string(record.model_error.empty() ? "" : " and ") + "the scatter between repeats";
    own = fit_apart(input, record.fit, record.repeats);
    record.own_residuals = own.residuals;
  }
  record.options = input.options;
  // Without sigma the scatter of repeats is in the fit alone, not in what profiles know.
  const bool known = !scattered || !input.curves.front().sigma.empty();
  if (input.profile_intervals && known && record.fit.converged && record.fit.degrees_of_freedom > 0)
    add_intervals(models, record);
  return own;
}

}  // namespace fingertip::studies::inline fits::inline models
