#include "studies/fits/models/fit_models.h"

#include <fmt/format.h>

#include <algorithm>

#include "calibration/press_fit/damping_models.h"
#include "calibration/press_fit/lattice_forward_model.h"
#include "calibration/press_fit/stretch_models.h"
#include "calibration/statistics/curve_checks.h"
#include "lattice/press/setup_fields.h"
#include "lattice/press/static_press.h"
#include "meshes/press/no_equilibrium.h"
#include "meshes/tables/fields_json.h"
#include "studies/fits/models/continuum_model.h"
#include "studies/fits/models/fit_relaxation.h"
#include "studies/fits/models/fit_rig.h"
#include "studies/jobs/digest.h"
#include "studies/presses/press_record.h"
#include "studies/presses/reference_job.h"

namespace fingertip::studies::inline fits::inline models {

using calibration::CurveFitOptions;
using calibration::ForwardModel;
using calibration::MaterialParameter;
using nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

/// The stiffness of a ramp errs by the square of the samples' distance.
constexpr int ramp_samples = 40;

/// What leaves out the values that lie beyond an indentation [m], as text to copy; empty where that
/// leaves fewer than three. A press behind a rig is computed deeper than its values go.
std::string rows_up_to(const FitInput& input, std::size_t i, double indentation) {
  if (i >= input.rows.size()) return {};
  const RowsOfValues& known = input.rows[i];
  std::vector<double> depths = input.curves[i].x;
  constexpr double margin = 0.98;  // the last step failed close by
  double reached = margin * indentation;
  if (is_travel(input, i)) {
    depths = input.travels[i]->indentations(input.curves[i], start_of(input.options));
    reached *= std::ranges::max(depths) / input.travels[i]->depths.back();
  }
  const auto beyond = std::ranges::find_if(depths, [&](double depth) { return depth > reached; });
  constexpr std::ptrdiff_t fewest = 3;
  if (beyond == depths.end() || beyond - depths.begin() < fewest) return {};
  return fmt::format(
      "\nThe fit without the rows beyond: in the TOML file that describes {}, or one that stands "
      "in "
      "its place in calibration.data (studies/manual/files.md),\n[[press]]\npath = '{}'\nrows = "
      "[{}, {}]",
      known.file, known.file, known.first, known.rows[std::size_t(beyond - depths.begin())] - 1);
}

/// A press that tells which rows lie beyond what it can answer for.
class MeasuredPress final : public ForwardModel {
 public:
  MeasuredPress(std::unique_ptr<ForwardModel> model, std::function<std::string(double)> remedy)
      : model_(std::move(model)), remedy_(std::move(remedy)) {}

  calibration::CurveSlopes evaluate(const Eigen::VectorXd& parameters) override {
    try {
      return model_->evaluate(parameters);
    } catch (const meshes::NoEquilibrium& error) {
      throw meshes::NotConverged(error.what() + remedy_(error.indentation()));
    }
  }

 private:
  std::unique_ptr<ForwardModel> model_;
  std::function<std::string(double)> remedy_;
};

/// From first touch at the press's speed to its depth, then held.
std::unique_ptr<ForwardModel> ramp_model(lattice::PressSetup setup, const std::vector<double>& time,
                                         const std::function<bool()>& go_on) {
  const double depth = setup.protocol.depth;
  setup.protocol.samples.clear();
  for (int i = 1; i <= ramp_samples; ++i)
    setup.protocol.samples.push_back(depth * i / ramp_samples);
  const auto press = lattice::run_static_press(
      setup, [&](const lattice::StaticOutcome&, double) { return go_on(); });
  return std::make_unique<calibration::RampModel>(
      time, calibration::Ramp{setup.protocol.speed, depth / setup.protocol.speed},
      calibration::interpolated_force(press.response));
}

std::unique_ptr<ForwardModel> model_of(const FitInput& input, std::size_t i,
                                       const JobContext& context,
                                       const std::function<bool()>& go_on) {
  const std::vector<double>& x = input.curves[i].x;
  const std::vector<MaterialParameter> parameters = parameters_of(input);
  switch (input.kinds[i]) {
    case CurveKind::press:
      return std::make_unique<calibration::LatticeForwardModel>(input.presses[i], parameters,
                                                                go_on);
    case CurveKind::continuum:
      return std::make_unique<calibration::ScaledModel>(continuum_model(
          input.continua[i], parameters, fmt::format("{}_{}", input.place, i + 1), context));
    case CurveKind::uniaxial:
      return std::make_unique<calibration::UniaxialModel>(x, parameters, input.base.rubber);
    case CurveKind::simple_shear:
      return std::make_unique<calibration::SimpleShearModel>(x, parameters, input.base.rubber);
    case CurveKind::loss_factor: return std::make_unique<calibration::LossFactorModel>(x);
    case CurveKind::creep: return std::make_unique<calibration::CreepModel>(x);
    case CurveKind::ramp: return ramp_model(input.presses[i], x, go_on);
    case CurveKind::moving_press:
      return std::make_unique<calibration::MovingPressModel>(input.presses[i], x);
  }
  return nullptr;
}

/// A search never needs moduli so many times larger or smaller than those that meet the data best
/// at some Poisson's ratio.
constexpr double scale_range = 1e3;

void start_at(const Eigen::VectorXd& start, CurveFitOptions& options) {
  for (std::size_t i = 0; i < options.free.size(); ++i) {
    calibration::FreeParameter& free = options.free[i];
    if (free.scale > 0.0) free.scale *= start(Eigen::Index(i)) / free.start;
    free.start = start(Eigen::Index(i));
    const bool positive = free.parameter == MaterialParameter::shear_modulus ||
                          free.parameter == MaterialParameter::modulus;
    if (!positive) continue;
    free.lower = std::max(free.lower, free.start / scale_range);
    free.upper = std::min(free.upper, free.start * scale_range);
  }
}

/// The search starts from the scale of the data, not from the configuration's rubber.
void start_from_data(FitInput& input, const std::vector<calibration::Curve>& curves,
                     const std::vector<ForwardModel*>& models, CurveFitOptions& options) {
  if (!input.start_ratios.empty()) {
    std::vector<Eigen::VectorXd> starts =
        calibration::scaled_starts(curves, models, options, input.start_ratios);
    if (starts.empty()) return;
    start_at(starts.front(), options);
    options.other_starts.assign(starts.begin() + 1, starts.end());
  } else if (input.scale_to_data) {
    if (const auto start = calibration::scaled_start(curves, models, options))
      start_at(*start, options);
  }
}

/// A curve of force over the indentations that the rig's start makes of its travels.
calibration::Curve over_indentation(const FitInput& input, std::size_t i) {
  const calibration::Curve& curve = input.curves[i];
  const Eigen::VectorXd start = start_of(input.options);
  const Travel& travel = *input.travels[i];
  const std::vector<double> depths = travel.indentations(curve, start);
  calibration::Curve result;
  result.name = curve.name;
  for (std::size_t k = 0; k < depths.size(); ++k) {
    if (depths[k] <= (result.x.empty() ? 0.0 : result.x.back())) continue;
    result.x.push_back(depths[k]);
    result.y.push_back(curve.y[k] - travel.rig.force_offset.in(start));
    if (!curve.sigma.empty()) result.sigma.push_back(curve.sigma[k]);
    if (!curve.time.empty()) result.time.push_back(curve.time[k]);
  }
  return result;
}

}  // namespace

ordered_json curve_inputs(const FitInput& input, std::size_t i) {
  const calibration::Curve& curve = input.curves[i];
  ordered_json inputs = {{"name", curve.name},
                         {"condition", input.conditions[i]},
                         {"kind", int(input.kinds[i])},
                         {"quantities", {curve.x_quantity, curve.y_quantity}},
                         {"x", curve.x},
                         {"y", curve.y},
                         {"sigma", curve.sigma}};
  if (i < input.presses.size()) inputs["press"] = inputs_of(input.presses[i]);
  for (const calibration::FitBranch& branch : input.branches)
    for (const calibration::FitQuantity& each : {branch.share, branch.time})
      inputs["branches"].push_back(each.place ? ordered_json{{"free", *each.place}}
                                              : ordered_json(each.value));
  if (is_travel(input, i)) {
    inputs["time"] = curve.time;
    inputs["machine"] = input.travels[i]->machine;
    for (const auto member : calibration::rig_members) {
      const calibration::RigQuantity& each = input.travels[i]->rig.*member;
      inputs["rig"].push_back(each.place ? ordered_json{{"free", *each.place}}
                                         : ordered_json(each.value));
    }
  }
  if (input.kinds[i] == CurveKind::continuum)
    inputs["continuum"] = reference_job(input.continua[i]).key();
  // The ramp's lattice is static, its rubber's damping is not.
  if (input.kinds[i] == CurveKind::ramp) inputs["speed"] = input.presses[i].protocol.speed;
  return inputs;
}

FitModels::FitModels(const FitInput& input, const fs::path& folder, const JobContext& context,
                     const std::function<bool()>& go_on) {
  fs::create_directories(folder / "evaluations");
  for (std::size_t i = 0; i < input.curves.size(); ++i) {
    const bool travel = is_travel(input, i);
    models_.push_back(std::make_unique<MeasuredPress>(
        model_of(input, i, context, go_on),
        [input, i](double indentation) { return rows_up_to(input, i, indentation); }));
    remembering_.push_back(std::make_unique<calibration::RememberedModel>(
        *models_[i], folder / "evaluations" / fmt::format("curve_{}.jsonl", i + 1),
        Eigen::Index(travel ? input.travels[i]->depths.size() : input.curves[i].x.size()),
        Eigen::Index(material_parameters(input)), sha256(curve_inputs(input, i).dump())));
    if (travel)
      rigs_.push_back(behind_rig(input, i, input.travels[i]->rig, input.curves[i],
                                 Eigen::Index(input.options.free.size()), input.branches));
  }
}

std::vector<ForwardModel*> FitModels::addresses() const {
  std::vector<ForwardModel*> result;
  for (const auto& model : remembering_) result.push_back(model.get());
  for (std::size_t i = 0; i < rigs_.size(); ++i) result[i] = rigs_[i].get();
  return result;
}

std::unique_ptr<calibration::RigModel> FitModels::behind_rig(
    const FitInput& input, std::size_t i, const calibration::Rig& rig,
    const calibration::Curve& curve, Eigen::Index parameters,
    const std::vector<calibration::FitBranch>& branches) const {
  const std::vector<double>& depths =
      is_travel(input, i) ? input.travels[i]->depths : input.presses[i].protocol.samples;
  return std::make_unique<calibration::RigModel>(*remembering_[i], depths,
                                                 Eigen::Index(material_parameters(input)), rig,
                                                 curve.x, curve.time, parameters, branches);
}

Eigen::VectorXd FitModels::press_forces(std::size_t i, const Eigen::VectorXd& rubber) const {
  return remembering_[i]->evaluate(rubber).value;
}

std::vector<double> FitModels::indentations(std::size_t i,
                                            const Eigen::VectorXd& parameters) const {
  if (rigs_.empty()) return {};
  rigs_[i]->evaluate(parameters);
  return {rigs_[i]->indentation().begin(), rigs_[i]->indentation().end()};
}

void start_from_data(FitInput& input, const FitModels& models) {
  if (input.travels.empty())
    return start_from_data(input, input.curves, models.addresses(), input.options);
  std::vector<calibration::Curve> curves;
  std::vector<std::unique_ptr<calibration::RigModel>> presses;
  std::vector<ForwardModel*> list;
  CurveFitOptions options = input.options;
  const std::size_t count = material_parameters(input);
  options.free.resize(count);
  options.model_covariance = {};
  options.progress = input.options.progress;
  for (std::size_t i = 0; i < input.curves.size(); ++i) {
    curves.push_back(over_indentation(input, i));
    if (curves.back().x.size() < 2) {
      curves.pop_back();
      continue;
    }
    presses.push_back(
        models.behind_rig(input, i, {}, curves.back(), Eigen::Index(count),
                          calibration::held_at(input.branches, start_of(input.options))));
    list.push_back(presses.back().get());
  }
  if (curves.empty()) return;
  start_from_data(input, curves, list, options);
  std::ranges::copy(options.free, input.options.free.begin());
  const Eigen::VectorXd whole = start_of(input.options);
  for (const Eigen::VectorXd& other : options.other_starts) {
    Eigen::VectorXd& start = input.options.other_starts.emplace_back(whole);
    start.head(Eigen::Index(count)) = other;
  }
  add_starts_in_time(input);
}

}  // namespace fingertip::studies::inline fits::inline models
