#include "studies/run/fit_repeats.h"

#include <algorithm>
#include <map>

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

calibration::CurveFit fit_with_scatter(FitInput& input,
                                       const std::vector<calibration::ForwardModel*>& models,
                                       const calibration::CurveFit& first,
                                       const std::vector<calibration::Repeats>& repeats) {
  const Eigen::MatrixXd more =
      calibration::covariance_of(repeats, input.curves, first, zeros(input, first.estimates));
  Eigen::MatrixXd& covariance = input.options.model_covariance;
  covariance = covariance.size() == 0 ? more : Eigen::MatrixXd(covariance + more);
  calibration::CurveFitOptions options = input.options;
  options.other_starts.clear();
  for (std::size_t i = 0; i < options.free.size(); ++i)
    options.free[i].start = first.estimates(Eigen::Index(i));
  calibration::CurveFit fit = calibration::fit_curves(input.curves, models, options);
  fit.evaluations += first.evaluations;
  return fit;
}

}  // namespace fingertip::studies
