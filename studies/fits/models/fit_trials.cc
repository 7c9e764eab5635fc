#include "studies/fits/models/fit_trials.h"

#include <algorithm>
#include <deque>
#include <map>

#include "studies/fits/models/fit_repeats.h"
#include "studies/fits/models/fit_rig.h"

namespace fingertip::studies::inline fits::inline models {

using calibration::Curve;
using calibration::CurveFit;
using calibration::FreeParameter;
using calibration::MaterialParameter;
using calibration::OmittedEffect;
using calibration::Rig;
using calibration::rig_members;
using calibration::rig_parameters;
using calibration::ScoreTest;
using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr int max_trials = 200;
constexpr double max_stiffening = 0.3;

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

/// What is freed, for people.
OmittedEffect effect_of(const Freed& freed) {
  if (freed.kind == Freed::rubber)
    return {other_rubber_name,
            freed.of,
            "these presses ask for another modulus than the others: another rubber or batch, or "
            "finger, obstacle or load cell are not as described",
            "1",
            {},
            0.0,
            0.0,
            "the others' modulus"};
  if (freed.stiffens)
    return {stiffening_name,
            freed.of,
            "the force grows faster with depth than the model's, and no machine makes "
            "that: the rubber sticks, its law stiffens, or obstacle or shape are others",
            "1",
            {},
            0.0,
            0.0,
            "the deepest force"};
  const MaterialParameter parameter = rig_parameters[freed.kind];
  return {std::string(calibration::name(parameter)),
          freed.of,
          cause_of(parameter),
          std::string(calibration::unit(parameter)),
          {}};
}

/// What is sought of that of `rig_parameters` though nobody told it.
bool is_untold(const FitCurve& curve, std::size_t k) {
  const RigSettings& rig = curve.travel->settings;
  const RigSetting* settings[] = {&rig.touch_offset, &rig.compliance, &rig.force_offset,
                                  &rig.drift};
  return settings[k]->deviation > 0.0 && !settings[k]->given;
}

/// Whether the fit seeks that of `rig_parameters` as it was told.
bool is_fitted(const FitCurve& curve, std::size_t k) {
  return curve.travel && (curve.travel->rig.*rig_members[k]).place && !is_untold(curve, k);
}

/// The press of a rubber that is found, times a factor, that of a place among the parameters.
class ScaledPress final : public calibration::ForwardModel {
 public:
  ScaledPress(VectorXd forces, Index place) : forces_(std::move(forces)), place_(place) {}
  calibration::CurveSlopes evaluate(const VectorXd& parameters) override {
    Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(forces_.size(), parameters.size());
    slopes.col(place_) = forces_;
    return {parameters(place_) * forces_, slopes};
  }

 private:
  VectorXd forces_;
  Index place_;
};

/// Presses that differ, each against all others; of two the one that was not given first.
void add_rubbers(const FitInput& input, std::vector<Freed>& held) {
  std::vector<std::vector<std::size_t>> presses = alike(input);
  if (presses.size() < 2) return;
  if (presses.size() == 2)
    std::erase_if(presses, [](const auto& curves) { return curves.front() == 0; });
  for (const auto& curves : presses)
    held.push_back({Freed::rubber,
                    input.curves[curves.front()].name + (curves.size() > 1 ? " and repeats" : ""),
                    curves});
}

}  // namespace

std::vector<Freed> held_by(const FitInput& input, bool scatter) {
  std::vector<Freed> held;
  const std::size_t curves = input.curves.size();
  std::map<std::string, std::vector<std::size_t>> machines;
  for (std::size_t i = 0; i < curves; ++i)
    machines[input.curves[i].travel ? input.curves[i].travel->machine : ""].push_back(i);
  for (std::size_t k = 0; k < rig_members.size(); ++k) {
    if (rig_parameters[k] == MaterialParameter::compliance) {
      for (const auto& [machine, which] : machines)
        for (const bool stiffens : {false, true})
          if (!is_fitted(input.curves[which.front()], k))
            held.push_back({k, machines.size() == 1 ? "" : machine, which, stiffens});
      continue;
    }
    for (std::size_t i = 0; i < curves; ++i) {
      const FitCurve& curve = input.curves[i];
      const bool no_times = rig_parameters[k] == MaterialParameter::drift && curve.time.empty();
      if (!no_times && !is_fitted(curve, k))
        held.push_back({k, curves == 1 ? "" : curve.name, {i}});
    }
  }
  if (!scatter) add_rubbers(input, held);
  return held;
}

Trials::Trials(const FitInput& input, const calibration::CurveFit& fit,
               const calibration::CurveFitOptions& options, const FitModels& models, bool scatter)
    : input_(input), options_(options), scales_(scatter ? Index(input.curves.size()) : 1) {
  const std::size_t rubber = material_parameters(input);
  FreeParameter scale{.parameter = MaterialParameter::modulus, .start = 1.0};
  const auto& first = options.free.front();
  if (rubber == 1 && scales_ == 1 && first.prior)
    scale.prior = calibration::Prior{first.prior->mean / fit.estimates(0),
                                     first.prior->deviation / fit.estimates(0)};
  options_.free.assign(std::size_t(scales_), scale);
  options_.start_once();
  options_.progress = {};
  options_.max_evaluations = max_trials;
  options_.value_deviation = fit.residual_deviation;  // the same for all that are compared
  std::vector<bool> held(options.free.size());
  for (const FitCurve& curve : input.curves)
    for (std::size_t k = 0; curve.travel && k < rig_members.size(); ++k)
      if (const auto& place = (curve.travel->rig.*rig_members[k]).place;
          place && is_untold(curve, k))
        held[std::size_t(*place)] = true;
  places_.assign(options.free.size(), -1);
  for (std::size_t k = rubber; k < options.free.size(); ++k) {
    if (held[k]) continue;
    places_[k] = Index(options_.free.size()) - scales_;
    options_.free.push_back(options.free[k]);
    options_.free.back().start = fit.estimates(Index(k));
  }
  for (std::size_t i = 0; i < input.curves.size(); ++i)
    forces_.push_back(models.press_forces(i, fit.estimates.head(Index(rubber))));
  before_ = fitted({});
}

ScoreTest Trials::of(const Freed& freed) {
  const CurveFit after = fitted({freed});
  ScoreTest found = calibration::score_test(before_, after, effect_of(freed));
  if (freed.stiffens) found.amount *= -1.5 / parameter_of(freed).scale;
  if (freed.kind == Freed::rubber) found.amount = after.estimates(scales_) / after.estimates(0);
  return found;
}

FreeParameter Trials::parameter_of(const Freed& freed) const {
  if (freed.kind == Freed::rubber)
    return {.parameter = MaterialParameter::modulus, .start = 1.0, .of = freed.of};
  FreeParameter free{.parameter = rig_parameters[freed.kind]};
  double reach = 0.0, force = 0.0, span = 0.0;
  for (const std::size_t i : freed.curves) {
    const FitCurve& curve = input_.curves[i];
    reach = std::max(reach, curve.x.back() - curve.x.front());
    force = std::max(force, *std::ranges::max_element(curve.y));
    if (!curve.time.empty()) span = std::max(span, curve.time.back() - curve.time.front());
    if (curve.travel) free.start = (curve.travel->rig.*rig_members[freed.kind]).value;
  }
  const double scales[] = {reach, reach / force, force, force / std::max(span, 1e-9)};
  free.scale = scales[freed.kind];
  free.of = freed.of;
  if (rig_parameters[freed.kind] == MaterialParameter::compliance) {
    free.lower = freed.stiffens ? -max_stiffening * free.scale : 0.0;
    free.upper = freed.stiffens ? 0.0 : free.start + highest_compliance * free.scale;
    free.start = std::clamp(free.start, free.lower, free.upper);
  }
  return free;
}

CurveFit Trials::fitted(const std::vector<Freed>& freed) {
  calibration::CurveFitOptions options = options_;
  Index scales = scales_;
  for (const Freed& each : freed)
    options.free.insert(
        each.kind == Freed::rubber ? options.free.begin() + scales++ : options.free.end(),
        parameter_of(each));
  const Index count = Index(options.free.size());
  const auto moved = [&](calibration::FitQuantity& quantity) {
    if (!quantity.place) return;
    const Index place = places_[std::size_t(*quantity.place)];
    if (place < 0)
      quantity.place.reset();
    else
      quantity.place = place + scales;
  };
  std::deque<ScaledPress> presses;
  std::vector<std::unique_ptr<calibration::RigModel>> models;
  std::vector<calibration::ForwardModel*> list;
  std::vector<calibration::FitBranch> branches = input_.branches;
  for (calibration::FitBranch& branch : branches) moved(branch.share), moved(branch.time);
  for (std::size_t i = 0; i < input_.curves.size(); ++i) {
    const FitCurve& curve = input_.curves[i];
    Rig rig = curve.travel ? curve.travel->rig : Rig{};
    for (const auto member : rig_members) moved(rig.*member);
    Index scale = scales_ == 1 ? 0 : Index(i);
    Index rubber = scales_, place = Index(options_.free.size()) + scales - scales_;
    for (const Freed& each : freed) {
      const Index own = each.kind == Freed::rubber ? rubber++ : place++;
      if (std::ranges::find(each.curves, i) == each.curves.end()) continue;
      if (each.kind == Freed::rubber)
        scale = own;
      else
        (rig.*rig_members[each.kind]).place = own;
    }
    presses.emplace_back(forces_[i], scale);
    models.push_back(
        std::make_unique<calibration::RigModel>(presses.back(), curve.press.protocol.samples,
                                                scales, rig, curve.x, curve.time, count, branches));
    list.push_back(models.back().get());
  }
  return calibration::fit_curves(curves_of(input_), list, options);
}

}  // namespace fingertip::studies::inline fits::inline models
