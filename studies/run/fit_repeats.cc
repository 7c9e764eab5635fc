#include "studies/run/fit_repeats.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>

#include "calibration/curves/fit_statistics.h"
#include "lattice/press/setup_fields.h"
#include "meshes/fields_json.h"

namespace fingertip::studies {

namespace {

/// What repeats have in common.
std::string press_of(const FitInput& input, std::size_t i) {
  const lattice::PressSetup& press = input.presses[i];
  const std::string machine = is_travel(input, i) ? input.travels[i]->machine : "";
  // An indentation's machine is its own (fit_measured.cc), the press may be the same.
  return meshes::json_of(press.geometry).dump() + "|" + input.conditions[i] + "|" +
         (input.curves[i].is_travel ? machine : "");
}

/// What the load cell tells without load, at every value of every curve [N].
std::vector<Eigen::VectorXd> zeros(const FitInput& input, const Eigen::VectorXd& estimates) {
  std::vector<Eigen::VectorXd> all;
  for (std::size_t i = 0; i < input.curves.size(); ++i) {
    const calibration::Curve& curve = input.curves[i];
    Eigen::VectorXd& zero = all.emplace_back(Eigen::VectorXd::Zero(Eigen::Index(curve.x.size())));
    if (!is_travel(input, i)) continue;
    const calibration::Rig& rig = input.travels[i]->rig;
    zero.array() += rig.force_offset.in(estimates);
    for (std::size_t k = 0; k < curve.time.size(); ++k)
      zero(Eigen::Index(k)) += rig.drift.in(estimates)*curve.time[k];
  }
  return all;
}

/// Curves of the same press, by what they have in common.
std::map<std::string, std::vector<std::size_t>> groups_of(const FitInput& input) {
  std::map<std::string, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < input.presses.size(); ++i)
    if (input.kinds[i] == CurveKind::press || input.kinds[i] == CurveKind::continuum)
      groups[press_of(input, i)].push_back(i);
  return groups;
}

}  // namespace

void share_depths(FitInput& input) {
  for (const auto& [press, curves] : groups_of(input)) {
    const auto reach = [&](std::size_t i) { return input.travels[i]->depths.back(); };
    const std::size_t deepest = *std::ranges::max_element(curves, {}, reach);
    for (const std::size_t i : curves) {
      Travel& travel = *input.travels[i];
      travel.depths = input.travels[deepest]->depths;
      input.presses[i].protocol.samples = travel.depths;
      input.presses[i].protocol.depth = travel.depths.back();
      input.continua[i].press_to(travel.depths);
    }
  }
}

std::vector<calibration::Repeats> repeats_in(const FitInput& input,
                                             const calibration::CurveFit& fit) {
  std::vector<std::size_t> nuisance;
  for (std::size_t k = 0; k < input.options.free.size(); ++k)
    if (calibration::is_of_the_rig(input.options.free[k].parameter)) nuisance.push_back(k);
  std::vector<calibration::RigQuantity> touch;
  for (std::size_t i = 0; i < input.curves.size(); ++i)
    touch.push_back(is_travel(input, i) ? input.travels[i]->rig.touch_offset
                                        : calibration::RigQuantity());
  std::vector<calibration::Repeats> found;
  for (const auto& [press, curves] : groups_of(input))
    if (curves.size() > 1)
      found.push_back(calibration::repeats_of(curves, input.curves, fit, nuisance, touch,
                                              zeros(input, fit.estimates)));
  return found;
}

calibration::CurveFit fit_apart(const FitInput& input, const calibration::CurveFit& fit,
                                const std::vector<calibration::Repeats>& repeats) {
  return calibration::apart(fit, repeats, input.curves, zeros(input, fit.estimates));
}

bool scatter(const std::vector<calibration::Repeats>& repeats) {
  return std::ranges::any_of(
      repeats, [](const calibration::Repeats& group) { return group.deviation > 0.0; });
}

namespace {

using calibration::Curve, calibration::CurveFit, calibration::Repeats;
using Eigen::Index, Eigen::MatrixXd;

/// From where `before` ended, with that covariance.
CurveFit fit_again(const FitInput& input, const std::vector<calibration::ForwardModel*>& models,
                   const std::vector<Curve>& curves, const CurveFit& before,
                   const MatrixXd& covariance) {
  calibration::CurveFitOptions options = input.options;
  options.model_covariance = covariance;
  options.other_starts.clear();
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

/// Whitened by the values' own deviation alone, as a fit without sigma is, whose chi-square tells
/// nothing.
void make_plain(CurveFit& fit, double deviation) {
  const Index count = fit.whitening.rows();
  fit.jacobian = fit.whitening.ldlt().solve(fit.jacobian) / deviation;
  fit.whitening = MatrixXd::Identity(count, count) / deviation;
  fit.whitened_residuals.clear();
  fit.chi_square.reset(), fit.chi_square_probability.reset();
  fit.birge_ratio = 1.0;
}

/// The variance between repeats is known from as many as there are.
void widen(CurveFit& fit, const std::vector<Repeats>& repeats, const MatrixXd& scattered) {
  int freedom = 0;
  for (const Repeats& group : repeats)
    if (group.deviation > 0.0) freedom += int(group.curves.size()) - 1;
  const MatrixXd between = fit.influence * scattered * fit.influence.transpose();
  for (Index i = 0; i < fit.estimates.size(); ++i) {
    const double within = std::max(0.0, fit.covariance(i, i) - between(i, i)),
                 quantile = calibration::normal_95() * fit.birge_ratio;
    const double half = std::hypot(quantile * std::sqrt(within),
                                   calibration::student_95(freedom) * std::sqrt(between(i, i)));
    fit.lower(i) = fit.estimates(i) - half;
    fit.upper(i) = fit.estimates(i) + half;
  }
}

}  // namespace

CurveFit fit_with_scatter(FitInput& input, const std::vector<calibration::ForwardModel*>& models,
                          const CurveFit& first, std::vector<Repeats>& repeats) {
  constexpr int rounds = 8;
  constexpr double close = 0.01;  // of a standard error
  const bool known = !input.curves.front().sigma.empty();
  MatrixXd& covariance = input.options.model_covariance;
  const MatrixXd base = covariance;
  CurveFit fit = first;
  MatrixXd scattered;
  for (int round = 0; round < (known ? 1 : rounds); ++round) {
    const CurveFit before = fit;
    scattered = calibration::covariance_of(repeats, input.curves, fit, zeros(input, fit.estimates));
    covariance = base.size() == 0 ? scattered : MatrixXd(base + scattered);
    if (known) {
      fit = fit_again(input, models, input.curves, fit, covariance);
      break;
    }
    const double deviation = std::max(1.0 / fit_apart(input, fit, repeats).whitening(0, 0),
                                      1e-9 * fit.residual_deviation);
    fit = fit_again(input, models, with_sigma(input.curves, deviation), fit, covariance);
    make_plain(fit, deviation);
    const std::vector<Repeats> again = repeats_in(input, fit);
    if (!scatter(again)) break;
    repeats = again;
    const Eigen::VectorXd step = (fit.estimates - before.estimates).cwiseAbs();
    if ((step.array() <= close * fit.standard_errors.array()).all()) break;
  }
  widen(fit, repeats, scattered);
  return fit;
}

}  // namespace fingertip::studies
