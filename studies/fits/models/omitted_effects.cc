#include "studies/fits/models/omitted_effects.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "calibration/press_fit/model_error.h"
#include "studies/fits/models/fit_rig.h"
#include "studies/fits/models/fit_trials.h"

namespace fingertip::studies::inline fits::inline models {

using calibration::Curve;
using calibration::OmittedEffect;
using calibration::ScoreTest;
using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Another theory is there or not; coarse lattices tell its forces to a half.
constexpr double max_excess = 1.5;

constexpr const char* relaxation_name = "relaxation";

/// Causes of smooth curves resemble each other: such a share of the best one's decrease is as good.
constexpr double nearly_all = 0.9;

/// The forces that the fit has for a curve.
VectorXd fitted_forces(const FitInput& input, const calibration::CurveFit& fit, std::size_t i) {
  return values_of(input.curves[i]) - fit.residuals[i];
}

template <typename Do>
void if_it_can_be(const Do& act) {
  try {
    act();
  } catch (const meshes::NotConverged&) {
  } catch (const meshes::InvalidInput&) {
  }
}

/// Of every press; empty where one of them finds no equilibrium.
std::vector<std::vector<double>> excess_of(const FitInput& input,
                                           Eigen::VectorXd (*theory)(lattice::PressSetup)) {
  std::vector<std::vector<double>> excess;
  if_it_can_be([&] {
    for (const FitCurve& curve : input.curves) {
      const VectorXd own = theory(curve.press);
      excess.emplace_back(own.begin(), own.end());
    }
  });
  if (excess.size() != input.curves.size()) excess.clear();
  return excess;
}

/// By how much another theory's forces exceed the model's, relative, at every sample of every
/// press.
struct Excess {
  std::string name;        ///< "finite strain"
  const char* cause = "";  ///< for people
  std::vector<std::vector<double>> at_samples;
};

/// What a small-strain fit leaves out, and what the other contact would change.
std::vector<Excess> excesses_of(const FitInput& input) {
  std::vector<Excess> excesses;
  std::vector<std::vector<double>> finite;
  for (const FitCurve& curve : input.curves) finite.push_back(curve.finite_excess);
  const bool counts = std::ranges::find(input.known_errors, finite_strain_error,
                                        &KnownError::name) != input.known_errors.end();
  if (!finite.front().empty() && !counts)
    excesses.push_back({"finite strain",
                        "the data go beyond small strain (leave lattice.kinematics out)", finite});
  const bool slips = input.curves.front().press.protocol.contact != meshes::ContactMode::stick;
  auto other = excess_of(input, calibration::excess_of_other_contact);
  if (!other.empty())
    excesses.push_back({slips ? sticking_name : slip_name,
                        slips
                            ? "the rubber sticks to the obstacle (press.contact = \"stick\")"
                            : "the rubber slips on the obstacle (press.contact = \"frictionless\")",
                        std::move(other)});
  return excesses;
}

/// Of files that show a loop or a hold: a branch of the rubber that fades as long as their loading
/// takes, which is where it bends the loading most. Without times the speed counts as constant.
std::optional<OmittedEffect> relaxation(const FitInput& input, const calibration::CurveFit& fit) {
  OmittedEffect effect;
  effect.name = relaxation_name, effect.share_of = "the force at once";
  effect.cause =
      "the rubber's force falls with time, as its loop or hold shows; give its branches in "
      "rubber.relaxation, or fit them: calibration.parameters with \"relaxation\"";
  effect.change = VectorXd::Zero(first_value(input.curves, input.curves.size()));
  effect.least = effect.most = 0.0;
  for (std::size_t i = 0; i < input.curves.size(); ++i) {
    const Curve& curve = input.curves[i];
    const VectorXd forces = fitted_forces(input, fit, i);
    const std::vector<double>& times = curve.time.empty() ? curve.x : curve.time;
    const double constant = times.back() - times.front();
    if (!(constant > 0.0) || !(forces(forces.size() - 1) > 0.0)) continue;
    const double shown = calibration::fading_of(curve.course, forces, curve.x, times, constant);
    if (!(shown > 0.0)) continue;
    effect.most = std::max(effect.most, std::min(1.0, max_excess * shown));
    effect.change.segment(first_value(input.curves, i), forces.size()) =
        calibration::relaxation_change(forces, times, constant);
  }
  if (effect.most == 0.0) return std::nullopt;
  return effect;
}

}  // namespace

std::vector<std::vector<double>> excess_of_finite_strain(const FitInput& input) {
  if (input.problem != CalibrationProblem::experiment ||
      input.base.lattice.kinematics == lattice::Kinematics::finite)
    return {};
  return excess_of(input, calibration::excess_of_finite_strain);
}

std::vector<ScoreTest> score_tests_of(const FitInput& input, const calibration::CurveFit& fit,
                                      const calibration::CurveFitOptions& options,
                                      const FitModels& models, bool scatter) {
  std::vector<ScoreTest> found;
  if (input.problem != CalibrationProblem::experiment || !has_presses(input)) return found;
  if_it_can_be([&] {  // a press without forces has no rig
    Trials trials(input, fit, options, models, scatter);
    const calibration::CurveFit& base = trials.base();
    std::vector<OmittedEffect> effects;
    for (const Excess& excess : excesses_of(input)) {
      std::vector<VectorXd> changes;
      for (std::size_t i = 0; i < input.curves.size(); ++i) {
        const std::vector<double> relative =
            at_values(input.curves[i], start_of(input.options), excess.at_samples[i]);
        changes.push_back(
            fitted_forces(input, base, i)
                .cwiseProduct(VectorXd::Map(relative.data(), Index(relative.size()))));
      }
      effects.push_back({excess.name, "", excess.cause, "1", calibration::stacked(changes), 0.0,
                         max_excess, "what coarse lattices compute for it"});
    }
    if (input.branches.empty())  // else it is in the model
      if (auto fades = relaxation(input, base)) effects.push_back(*std::move(fades));
    found = calibration::score_tests(base, trials.options(), effects);
    for (const Freed& each : held_by(input, scatter))
      if_it_can_be([&] { found.push_back(trials.of(each)); });
  });
  std::ranges::stable_sort(found, std::greater<>(), &ScoreTest::decrease);
  // What explains as much and shows itself besides goes first: no other cause makes a loop.
  // A stiffening has no cause of its own: those that are named go before it. A touch may be
  // anywhere, a load cell's zero is usually small.
  using enum calibration::MaterialParameter;
  const auto is_first = [&](std::string_view name) {
    return !found.empty() && found.front().name == name;
  };
  const bool unnamed = is_first(stiffening_name),
             of_zero = is_first(calibration::name(force_offset));
  const auto better = std::ranges::find_if(found, [&](const ScoreTest& each) {
    return each.decrease > nearly_all * found.front().decrease &&
           (each.name == relaxation_name || (unnamed && each.name != stiffening_name) ||
            (of_zero && each.name == calibration::name(touch_offset)));
  });
  if (better != found.end()) std::rotate(found.begin(), better, better + 1);
  return found;
}

}  // namespace fingertip::studies::inline fits::inline models
