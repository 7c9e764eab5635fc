#include "studies/run/fit_suspects.h"

#include <algorithm>
#include <deque>
#include <map>

namespace fingertip::studies {

using calibration::Accusation;
using calibration::Curve;
using calibration::FreeParameter;
using calibration::MaterialParameter;
using calibration::Rig;
using calibration::RigQuantity;
using calibration::Suspect;
using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr MaterialParameter of_rigs[] = {MaterialParameter::touch_offset,
                                         MaterialParameter::compliance,
                                         MaterialParameter::force_offset, MaterialParameter::drift};

const char* cause_of(MaterialParameter parameter) {
  switch (parameter) {
    case MaterialParameter::touch_offset:
      return "the finger touches earlier or later than the zero of the travel says";
    case MaterialParameter::compliance:
      return "frame, load cell, grips or glue give way beside the finger";
    case MaterialParameter::force_offset:
      return "the load cell was not zeroed with the finger free";
    default: return "the load cell's zero moves, as while it warms up";
  }
}

RigQuantity& quantity_of(Rig& rig, Index k) {
  RigQuantity* const all[] = {&rig.touch_offset, &rig.compliance, &rig.force_offset, &rig.drift};
  return *all[k];
}

/// Whether the fit seeks that of `of_rigs` itself.
bool is_fitted(const FitInput& input, std::size_t i, Index k) {
  if (!is_travel(input, i)) return false;
  Rig rig = input.travels[i]->rig;
  return quantity_of(rig, k).place.has_value();
}

/// The press of a rubber that is found, times a factor.
class ScaledPress final : public calibration::ForwardModel {
 public:
  explicit ScaledPress(VectorXd forces) : forces_(std::move(forces)) {}
  calibration::CurveSlopes evaluate(const VectorXd& parameters) override {
    return {parameters(0) * forces_, forces_};
  }

 private:
  VectorXd forces_;
};

/// Fits of the forces' scale, of what of the rigs is fitted and of one thing more.
class Trials {
 public:
  Trials(const FitInput& input, const calibration::CurveFit& fit,
         const calibration::CurveFitOptions& options, const FitModels& models)
      : input_(input), options_(options) {
    const std::size_t rubber = material_parameters(input);
    shift_ = Index(rubber) - 1;
    FreeParameter scale{.parameter = MaterialParameter::modulus, .start = 1.0};
    const auto& first = options.free.front();
    if (rubber == 1 && first.prior)
      scale.prior = calibration::Prior{first.prior->mean / fit.estimates(0),
                                       first.prior->deviation / fit.estimates(0)};
    options_.free = {scale};
    options_.other_starts.clear();
    options_.progress = {};
    options_.max_evaluations = most_trials;
    for (std::size_t k = rubber; k < options.free.size(); ++k) {
      options_.free.push_back(options.free[k]);
      options_.free.back().start = fit.estimates(Index(k));
    }
    for (std::size_t i = 0; i < input.curves.size(); ++i)
      presses_.emplace_back(models.press_forces(i, fit.estimates.head(Index(rubber))));
    before_ = fitted(options_, Index(-1), {});
  }

  /// Throws as fits do.
  Accusation of(const Suspect& what, Index k, const std::vector<std::size_t>& curves) {
    calibration::CurveFitOptions options = options_;
    FreeParameter free{.parameter = of_rigs[k]};
    double reach = 0.0, force = 0.0, span = 0.0;
    for (const std::size_t i : curves) {
      const Curve& curve = input_.curves[i];
      reach = std::max(reach, curve.x.back() - curve.x.front());
      force = std::max(force, *std::ranges::max_element(curve.y));
      if (!curve.time.empty()) span = std::max(span, curve.time.back() - curve.time.front());
      if (is_travel(input_, i)) {
        Rig rig = input_.travels[i]->rig;
        free.start = quantity_of(rig, k).value;
      }
    }
    const double scales[] = {reach, reach / force, force, force / std::max(span, 1e-9)};
    free.scale = scales[k];
    if (of_rigs[k] == MaterialParameter::compliance) {
      free.lower = free.start - lowest_compliance * free.scale;
      free.upper = free.start + highest_compliance * free.scale;
    }
    options.free.push_back(free);
    return calibration::accusation(before_, fitted(options, k, curves), what);
  }

 private:
  static constexpr int most_trials = 200;
  static constexpr double lowest_compliance = 0.1, highest_compliance = 0.9;

  calibration::CurveFit fitted(const calibration::CurveFitOptions& options, Index k,
                               const std::vector<std::size_t>& curves) {
    std::vector<std::unique_ptr<calibration::RigModel>> models;
    std::vector<calibration::ForwardModel*> list;
    const Index count = Index(options.free.size());
    for (std::size_t i = 0; i < input_.curves.size(); ++i) {
      const bool travel = is_travel(input_, i);
      Rig rig = travel ? input_.travels[i]->rig : Rig{};
      for (Index q = 0; q < 4; ++q)
        if (auto& place = quantity_of(rig, q).place) place = *place - shift_;
      if (k >= 0 && std::ranges::find(curves, i) != curves.end())
        quantity_of(rig, k).place = count - 1;
      models.push_back(std::make_unique<calibration::RigModel>(
          presses_[i], travel ? input_.travels[i]->depths : input_.presses[i].protocol.samples, 1,
          rig, input_.curves[i].x, input_.curves[i].time, count));
      list.push_back(models.back().get());
    }
    return calibration::fit_curves(input_.curves, list, options);
  }

  const FitInput& input_;
  calibration::CurveFitOptions options_;
  Index shift_ = 0;
  std::deque<ScaledPress> presses_;
  calibration::CurveFit before_;
};

/// Curves one below the other.
struct Stack {
  std::vector<VectorXd> fitted;
  std::vector<Index> first;
  Index values = 0;
};

Stack stacked(const FitInput& input, const calibration::CurveFit& fit) {
  Stack stack;
  for (std::size_t i = 0; i < input.curves.size(); ++i) {
    const auto& y = input.curves[i].y;
    stack.first.push_back(stack.values);
    stack.fitted.push_back(VectorXd::Map(y.data(), Index(y.size())) - fit.residuals[i]);
    stack.values += Index(y.size());
  }
  return stack;
}

}  // namespace

namespace {

/// The rig's quantities that the fit holds, each freed alone.
void add_rigs(const FitInput& input, Trials& trials, std::vector<Accusation>& found) {
  const std::size_t curves = input.curves.size();
  std::map<std::string, std::vector<std::size_t>> machines;
  for (std::size_t i = 0; i < curves; ++i)
    machines[is_travel(input, i) ? input.travels[i]->machine : ""].push_back(i);
  const auto tried = [&](Index k, const std::string& of, const std::vector<std::size_t>& which) {
    const MaterialParameter parameter = of_rigs[k];
    const Suspect what{std::string(calibration::name(parameter)),
                       of,
                       cause_of(parameter),
                       std::string(calibration::unit(parameter)),
                       {}};
    try {
      found.push_back(trials.of(what, k, which));
    } catch (const meshes::NotConverged&) {  // nothing is known of it
    } catch (const meshes::InvalidInput&) {
    }
  };
  for (Index k = 0; k < 4; ++k) {
    if (of_rigs[k] == MaterialParameter::compliance) {
      for (const auto& [machine, which] : machines)
        if (!is_fitted(input, which.front(), k))
          tried(k, machines.size() == 1 ? "" : machine, which);
      continue;
    }
    for (std::size_t i = 0; i < curves; ++i) {
      const bool no_times = of_rigs[k] == MaterialParameter::drift && input.curves[i].time.empty();
      if (!no_times && !is_fitted(input, i, k))
        tried(k, curves == 1 ? "" : input.curves[i].name, {i});
    }
  }
}

}  // namespace

std::vector<Accusation> accusations_of(const FitInput& input, const calibration::CurveFit& fit,
                                       const calibration::CurveFitOptions& options,
                                       const FitModels& models) {
  std::vector<Accusation> found;
  if (input.problem != CalibrationProblem::experiment || input.presses.empty()) return found;
  const Stack stack = stacked(input, fit);
  std::vector<Suspect> suspects;
  for (const Excess& excess : input.excesses) {
    Suspect& suspect = suspects.emplace_back(
        Suspect{excess.name, "", excess.cause, "1", VectorXd::Zero(stack.values)});
    for (std::size_t i = 0; i < input.curves.size(); ++i) {
      const std::vector<double> relative = at_values(input, i, excess.at_samples[i]);
      suspect.change.segment(stack.first[i], Index(relative.size())) =
          stack.fitted[i].cwiseProduct(VectorXd::Map(relative.data(), Index(relative.size())));
    }
  }
  found = calibration::accusations(fit, options, suspects);
  try {
    Trials trials(input, fit, options, models);
    add_rigs(input, trials, found);
  } catch (const meshes::NotConverged&) {  // a press without forces has no rig
  } catch (const meshes::InvalidInput&) {
  }
  std::ranges::stable_sort(found, std::greater<>(), &Accusation::decrease);
  return found;
}

}  // namespace fingertip::studies
