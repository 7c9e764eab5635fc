#include "studies/fits/models/fit_repeats.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "calibration/statistics/curve_checks.h"
#include "calibration/statistics/curve_residuals.h"
#include "calibration/statistics/fit_statistics.h"
#include "calibration/statistics/posterior.h"
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
  const auto by_rows = [&](std::size_t i) {
    return input.curves[i].travel->depths == input.curves[i].x;
  };
  for (const auto& curves : alike(input)) {
    std::set<double> rows;  // none unless they are the depths of all: between them nothing is asked
    if (std::ranges::all_of(curves, by_rows))
      for (const std::size_t i : curves)
        rows.insert(input.curves[i].x.begin(), input.curves[i].x.end());
    double deepest = 0.0;
    for (const std::size_t i : curves) {
      FitCurve& curve = input.curves[i];
      // Further rows of a press begin under load: where it was touched those before tell.
      if (curve.continues) {
        const FitCurve& before = input.curves[*curve.continues];
        curve.travel = continued(*std::move(curve.travel), curve, *before.travel, before);
      }
      deepest = std::max(deepest, curve.travel->depths.back());
    }
    const std::vector<double> depths =
        rows.empty() ? calibration::depths_for_rig(deepest) : std::vector(rows.begin(), rows.end());
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

using calibration::Curve, calibration::CurveFit, calibration::Repeats;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

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

/// Over the deepest press of the same kind: what a model misses is smooth on this scale. It is a
/// share of the force and, independent of that, a tenth of such a share of the largest one: errors
/// of what is pressed grow with the force, those of how it is touched do not.
constexpr double smooth_length = 0.5, near_touch = 0.1;

}  // namespace

std::vector<std::vector<std::size_t>> sharing(const FitInput& input) {
  std::vector<std::vector<std::size_t>> groups = alike(input);
  for (std::size_t i = 0; i < input.curves.size(); ++i)
    if (std::ranges::none_of(
            groups, [&](const auto& group) { return std::ranges::find(group, i) != group.end(); }))
      groups.push_back({i});
  return groups;
}

ForceAndDepth presses_at(const FitInput& input, const VectorXd& estimates,
                         const VectorXd& computed) {
  const std::vector<Curve> curves = curves_of(input);
  ForceAndDepth at{VectorXd(), VectorXd(computed.size())};
  for (std::size_t i = 0; i < input.curves.size(); ++i) {
    const std::vector<double> depths =
        input.curves[i].travel ? input.curves[i].travel->indentations(curves[i], estimates)
                               : curves[i].x;
    at.depth.segment(first_value(curves, i), Index(depths.size())) =
        VectorXd::Map(depths.data(), Index(depths.size()));
  }
  // Exactly none before touch, where the difference is round-off.
  const VectorXd force = computed - calibration::stacked(zeros(input, estimates));
  at.force = (at.depth.array() > 0.0).select(force.cwiseMax(0.0), 0.0);
  return at;
}

VectorXd told_deviations(const FitInput& input, double deviation) {
  const std::vector<Curve> curves = curves_of(input);
  const VectorXd values = calibration::all_values(curves);
  VectorXd deviations =
      VectorXd::Constant(values.size(), std::max(deviation, 1e-9 * values.cwiseAbs().maxCoeff()));
  for (std::size_t i = 0; i < curves.size(); ++i)
    if (const auto& sigma = curves[i].sigma; !sigma.empty())
      deviations.segment(first_value(curves, i), Index(sigma.size())) =
          VectorXd::Map(sigma.data(), Index(sigma.size()));
  return deviations;
}

MatrixXd misfit_columns(const VectorXd& force, const VectorXd& depth, double deepest) {
  const MatrixXd smooth = calibration::smooth_columns(depth / deepest, smooth_length);
  const VectorXd touched = near_touch * force.maxCoeff() * force.cwiseSign();
  MatrixXd columns(smooth.rows(), 2 * smooth.cols());
  columns << force.asDiagonal() * smooth, touched.asDiagonal() * smooth;
  return columns;
}

namespace {

/// Priors of the deviations of that share and of factors between repeats.
constexpr double misfit_scale = 0.01, scatter_scale = 0.05;

/// How many of a group's curves are fitted.
std::size_t fitted_of(const std::vector<std::size_t>& group, std::size_t fitted) {
  return std::size_t(std::ranges::count_if(group, [&](std::size_t i) { return i < fitted; }));
}

}  // namespace

std::vector<calibration::ErrorComponent> components_of(const FitInput& input,
                                                       const ForceAndDepth& at,
                                                       std::size_t fitted) {
  const std::vector<Curve> curves = curves_of(input);
  calibration::ErrorComponent missed{{}, misfit_scale}, factors{{}, scatter_scale};
  const auto append = [&](MatrixXd& all, const MatrixXd& columns) {
    all.conservativeResize(at.force.size(), all.cols() + columns.cols());
    all.rightCols(columns.cols()) = columns;
  };
  const auto rows_of = [&](std::size_t i) {
    return Eigen::seqN(first_value(curves, i), Index(curves[i].y.size()));
  };
  const auto groups = sharing(input);
  const bool has_repeats =
      std::ranges::any_of(groups, [&](const auto& group) { return fitted_of(group, fitted) > 1; });
  for (const auto& group : groups) {
    double deepest = 0.0;
    for (const std::size_t i : group) deepest = std::max(deepest, at.depth(rows_of(i)).maxCoeff());
    MatrixXd columns;
    for (const std::size_t i : group) {
      const VectorXd force = at.force(rows_of(i));
      const MatrixXd own = misfit_columns(force, at.depth(rows_of(i)), deepest);
      if (columns.size() == 0) columns = MatrixXd::Zero(at.force.size(), own.cols());
      columns(rows_of(i), Eigen::all) = own;
      if (fitted_of(group, fitted) < 2 && (i < fitted || !has_repeats)) continue;
      if (input.curves[i].continues) continue;
      VectorXd factor = VectorXd::Zero(at.force.size());
      for (const std::size_t k : group)
        if (k == i || input.curves[k].continues == i) factor(rows_of(k)) = at.force(rows_of(k));
      append(factors.columns, factor);
    }
    append(missed.columns, columns);
  }
  std::vector<calibration::ErrorComponent> components{missed};
  if (factors.columns.cols() > 0) components.push_back(factors);
  return components;
}

namespace {

using Models = std::vector<calibration::ForwardModel*>;

/// Of all values, per curve.
std::vector<VectorXd> by_curve(const FitInput& input, const VectorXd& all) {
  std::vector<VectorXd> lists;
  for (std::size_t i = 0; i < input.curves.size(); ++i)
    lists.emplace_back(all.segment(first_value(input.curves, i), Index(input.curves[i].y.size())));
  return lists;
}

/// Its values weighed by their noise, which repeats are compared with.
CurveFit by_noise_alone(const FitInput& input, const Models& models,
                        const calibration::Posterior& by, const VectorXd& told) {
  CurveFit fit = by.fit;
  fit.whitening = (by.errors.noise * told).cwiseInverse().asDiagonal();
  fit.jacobian =
      fit.whitening *
      calibration::linearised(curves_of(input), models, input.options.free, fit.estimates).jacobian;
  return fit;
}

/// Chi-square by what the files tell of noise and is known of the models, as of any fit.
void put_chi_square(CurveFit& fit, const FitInput& input, const VectorXd& told) {
  fit.chi_square.reset(), fit.chi_square_probability.reset();
  fit.whitened_residuals.clear();
  fit.birge_ratio = 1.0;
  if (input.curves.front().sigma.empty()) return;
  const MatrixXd& known = input.options.model_covariance;
  VectorXd whitened = calibration::stacked(fit.residuals);
  if (known.size() > 0)
    whitened = calibration::decomposed_covariance(known, told).inverse_root() * whitened;
  else
    whitened = whitened.cwiseQuotient(told);
  double squares = whitened.squaredNorm();
  for (std::size_t j = 0; j < input.options.free.size(); ++j)
    if (const auto& prior = input.options.free[j].prior)
      squares += std::pow((fit.estimates(Index(j)) - prior->mean) / prior->deviation, 2);
  fit.whitened_residuals = by_curve(input, whitened);
  fit.chi_square = squares;
  if (fit.degrees_of_freedom > 0)
    fit.chi_square_probability = calibration::chi_square_above(squares, fit.degrees_of_freedom);
}

/// Whether files tell the noise of their values.
bool is_told(const FitInput& input) {
  return !input.curves.front().sigma.empty();
}

calibration::ErrorsEntry entry_of(const calibration::ValueErrors& errors, const VectorXd& told,
                                  bool is_told, const VectorXd& values) {
  calibration::ErrorsEntry entry;
  entry.noise = errors.noise * std::sqrt(told.squaredNorm() / double(told.size()));
  if (is_told) entry.over_told = errors.noise;
  entry.misfit = calibration::relative_rms(errors.parts.front(), values);
  entry.misfit_upper = errors.upper_sizes.front();
  entry.misfit_seen = errors.seen.front();
  if (errors.sizes.size() > 1) entry.scatter = errors.sizes[1];
  entry.log_evidence = errors.log_evidence;
  return entry;
}

/// Intervals up to where chi-square has risen as far as it does at those of the posterior, in their
/// place where both ends are found.
void add_intervals(const Models& models, const calibration::Posterior& by,
                   calibration::FitRecord& record) {
  CurveFit& fit = record.fit;
  record.profiled.assign(fit.labels.size(), false);
  for (std::size_t i = 0; i < fit.labels.size(); ++i) {
    const Index j = Index(i);
    if (fit.at_bound[i] || !(by.fit.standard_errors(j) > 0.0)) continue;
    const double half_width = 0.5 * (fit.upper(j) - fit.lower(j)) / by.fit.standard_errors(j);
    const auto own =
        calibration::profile_interval(by.curves, models, by.options, by.fit, i, half_width);
    if (!std::isfinite(own.lower) || !std::isfinite(own.upper)) continue;
    fit.lower(j) = own.lower;
    fit.upper(j) = own.upper;
    record.profiled[i] = true;
  }
}

}  // namespace

calibration::Posterior posterior_of(const FitInput& input, const Models& models,
                                    const CurveFit& first) {
  return calibration::posterior_fit({.curves = curves_of(input),
                                     .models = models,
                                     .options = input.options,
                                     .deviations = told_deviations(input, first.residual_deviation),
                                     .noise_told = is_told(input),
                                     .components =
                                         [&](const VectorXd& estimates, const VectorXd& computed) {
                                           return components_of(
                                               input, presses_at(input, estimates, computed),
                                               input.curves.size());
                                         }},
                                    first);
}

void add_errors_and_intervals(const FitInput& input, const Models& models,
                              calibration::FitRecord& record) {
  record.options = input.options;
  if (input.problem != CalibrationProblem::experiment || !has_presses(input)) return;
  const VectorXd told = told_deviations(input, record.fit.residual_deviation);
  const calibration::Posterior by = posterior_of(input, models, record.fit);
  record.fit = by.fit;
  record.odd = by.odd;
  record.repeats = repeats_in(input, by_noise_alone(input, models, by, told));
  calibration::put_posterior(by.errors, input.options.free, record.fit);
  put_chi_square(record.fit, input, told);
  record.misfit_size = by.errors.sizes.front();
  record.errors = entry_of(by.errors, told, is_told(input), calibration::all_values(record.curves));
  if (scatter(record.repeats)) {
    record.model_error +=
        std::string(record.model_error.empty() ? "" : " and ") + "the scatter between repeats";
    record.own_residuals =
        by_curve(input, calibration::stacked(by.fit.residuals) - by.errors.parts.back());
  }
  if (input.profile_intervals && record.fit.converged) add_intervals(models, by, record);
}

}  // namespace fingertip::studies::inline fits::inline models
