#include "studies/fits/models/fit_models.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>

#include "calibration/press_fit/damping_models.h"
#include "calibration/press_fit/lattice_forward_model.h"
#include "calibration/press_fit/remembered_model.h"
#include "calibration/press_fit/scaled_model.h"
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
constexpr std::size_t ramp_samples = 40;

/// What leaves out the values that lie beyond an indentation [m], as text to copy; empty where that
/// leaves fewer than three. A press behind a rig is computed deeper than its values go.
std::string rows_up_to(const FitCurve& curve, const Eigen::VectorXd& start, double indentation) {
  const RowsOfValues& known = curve.rows;
  if (known.rows.empty()) return {};
  std::vector<double> depths = curve.x;
  constexpr double margin = 0.98;  // the last step failed close by
  double reached = margin * indentation;
  if (curve.travel) {
    depths = curve.travel->indentations(curve, start);
    reached *= std::ranges::max(depths) / curve.travel->depths.back();
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
  bool refine(const Eigen::VectorXd& parameters) override { return model_->refine(parameters); }

 private:
  std::unique_ptr<ForwardModel> model_;
  std::function<std::string(double)> remedy_;
};

/// From first touch at the press's speed to its depth, then held.
std::unique_ptr<ForwardModel> ramp_model(lattice::PressSetup setup, const std::vector<double>& time,
                                         const std::function<bool()>& go_on) {
  const double depth = setup.protocol.depth;
  setup.protocol.samples = meshes::even_depths(depth, ramp_samples);
  const auto press = lattice::run_static_press(
      setup, [&](const lattice::StaticOutcome&, double) { return go_on(); });
  return std::make_unique<calibration::RampModel>(
      time, calibration::Ramp{setup.protocol.speed, depth / setup.protocol.speed},
      calibration::interpolated_force(press.response));
}

/// Without data nobody searches: a press that is planned is asked for one rubber.
bool is_planned(const FitCurve& curve) {
  return curve.y.empty();
}

/// Whether the lattice is asked at few Poisson's ratios; at one rubber its own slopes are cheaper.
bool is_scaled(const FitInput& input, std::size_t i) {
  const FitCurve& curve = input.curves[i];
  return curve.kind == CurveKind::press && !is_planned(curve) && seeks_moduli_alone(input);
}

/// Whether one press of the lattice answers for both.
bool same_lattice(const FitCurve& a, const FitCurve& b) {
  return a.kind == CurveKind::press && b.kind == CurveKind::press &&
         is_planned(a) == is_planned(b) && inputs_of(a.press) == inputs_of(b.press);
}

std::unique_ptr<ForwardModel> model_of(const FitInput& input, std::size_t i,
                                       const JobContext& context,
                                       const std::function<bool()>& go_on) {
  using Use = calibration::ScaledModel::Use;
  const FitCurve& curve = input.curves[i];
  const std::vector<double>& x = curve.x;
  const std::vector<MaterialParameter> parameters = parameters_of(input);
  switch (curve.kind) {
    case CurveKind::press:
      if (is_scaled(input, i))
        return std::make_unique<calibration::LatticeByRatio>(curve.press, go_on);
      return std::make_unique<calibration::LatticeForwardModel>(curve.press, parameters, go_on);
    case CurveKind::continuum:
      return std::make_unique<calibration::ScaledModel>(
          continuum_model(curve.continuum, parameters, fmt::format("{}_{}", input.place, i + 1),
                          context, is_planned(curve) ? Use::near_one_ratio : Use::search));
    case CurveKind::loss_factor: return std::make_unique<calibration::LossFactorModel>(x);
    case CurveKind::creep: return std::make_unique<calibration::CreepModel>(x);
    case CurveKind::ramp: return ramp_model(curve.press, x, go_on);
    case CurveKind::moving_press:
      return std::make_unique<calibration::MovingPressModel>(curve.press, x);
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
    const auto [valleys, others] =
        calibration::scaled_starts(curves, models, options, input.start_ratios);
    if (valleys.empty()) return;
    start_at(valleys.front(), options);
    options.other_starts.assign(valleys.begin() + 1, valleys.end());
    options.reserve_starts = others;
  } else if (input.scale_to_data) {
    if (const auto start = calibration::scaled_start(curves, models, options))
      start_at(*start, options);
  }
}

/// A curve of force over the indentations that the rig's start makes of its travels.
calibration::Curve over_indentation(const FitCurve& curve, const Eigen::VectorXd& start) {
  const Travel& travel = *curve.travel;
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

ordered_json quantity_inputs(const calibration::FitQuantity& quantity) {
  return quantity.place ? ordered_json{{"free", *quantity.place}} : ordered_json(quantity.value);
}

}  // namespace

ordered_json curve_inputs(const FitInput& input, std::size_t i) {
  const FitCurve& curve = input.curves[i];
  // Everything that the judgement of a fit reads: a member more of a curve does not compile.
  const auto& [name, x_quantity, y_quantity, x, y, sigma, time, is_travel, zero_is_sought, in_time,
               course] = static_cast<const calibration::Curve&>(curve);
  ordered_json inputs = {{"name", name},
                         {"condition", curve.condition},
                         {"kind", int(curve.kind)},
                         {"quantities", {x_quantity, y_quantity}},
                         {"x", x},
                         {"y", y},
                         {"sigma", sigma},
                         {"time", time},
                         {"is", {is_travel, zero_is_sought, in_time}},
                         {"course", meshes::json_of(course)},
                         {"rows", curve.rows.rows},
                         {"known_errors", curve.known_errors},
                         {"finite_excess", curve.finite_excess}};
  if (curve.continues) inputs["continues"] = *curve.continues;
  if (has_presses(input)) inputs["press"] = inputs_of(curve.press);
  for (const calibration::FitBranch& branch : input.branches)
    for (const calibration::FitQuantity& each : {branch.share, branch.time})
      inputs["branches"].push_back(quantity_inputs(each));
  if (curve.travel) {
    inputs["machine"] = curve.travel->machine;
    for (const auto member : calibration::rig_members)
      inputs["rig"].push_back(quantity_inputs(curve.travel->rig.*member));
  }
  if (curve.kind == CurveKind::continuum)
    inputs["continuum"] = reference_job(curve.continuum).key();
  // The ramp's lattice is static, its rubber's damping is not.
  if (curve.kind == CurveKind::ramp) inputs["speed"] = curve.press.protocol.speed;
  return inputs;
}

/// The press of one curve or of repeats, which ask one after the other.
class FitModels::Press final : public ForwardModel {
 public:
  Press(const FitInput& input, std::size_t i, const fs::path& folder, const JobContext& context,
        const std::function<bool()>& go_on) {
    const FitCurve& curve = input.curves[i];
    model_ = std::make_unique<MeasuredPress>(
        model_of(input, i, context, go_on),
        [curve, start = start_of(input.options)](double indentation) {
          return rows_up_to(curve, start, indentation);
        });
    if (curve.kind == CurveKind::continuum) return;
    using Slopes = calibration::RememberedModel::Slopes;
    const bool scaled = is_scaled(input, i);
    remembered_ = std::make_unique<calibration::RememberedModel>(
        *model_, folder / "evaluations" / fmt::format("curve_{}.jsonl", i + 1),
        Eigen::Index(curve.travel ? curve.travel->depths.size() : curve.x.size()),
        Eigen::Index(scaled ? 1 : material_parameters(input)),
        sha256(curve_inputs(input, i).dump()), scaled ? Slopes::none : Slopes::known);
    if (scaled) scale(input, i);
  }

  calibration::CurveSlopes evaluate(const Eigen::VectorXd& parameters) override {
    const std::lock_guard lock(mutex_);
    return outermost().evaluate(parameters);
  }
  bool refine(const Eigen::VectorXd& parameters) override {
    const std::lock_guard lock(mutex_);
    return outermost().refine(parameters);
  }

 private:
  ForwardModel& outermost() {
    if (scaled_) return *scaled_;
    return remembered_ ? *remembered_ : *model_;
  }

  void scale(const FitInput& input, std::size_t i) {
    const lattice::PressSetup& setup = input.curves[i].press;
    const auto solve = [this](const std::vector<double>& ratios) {
      std::vector<Eigen::VectorXd> answers;
      for (const double nu : ratios)
        answers.push_back(remembered_->evaluate(Eigen::VectorXd::Constant(1, nu)).value);
      return answers;
    };
    // The energy of law A falls without bound for lambda < 0.
    const bool finite = setup.lattice.kinematics == lattice::Kinematics::finite;
    scaled_ = std::make_unique<calibration::ScaledModel>(solve, parameters_of(input), setup.rubber,
                                                         finite ? 0.0 : -0.9);
  }

  std::mutex mutex_;
  std::unique_ptr<ForwardModel> model_;
  std::unique_ptr<calibration::RememberedModel> remembered_;  ///< of `model_`
  std::unique_ptr<calibration::ScaledModel> scaled_;          ///< of lattices by moduli alone
};

FitModels::FitModels(const FitInput& input, const fs::path& folder, const JobContext& context,
                     const std::function<bool()>& go_on, const FitModels* first) {
  fs::create_directories(folder / "evaluations");
  for (std::size_t i = 0; i < input.curves.size(); ++i) {
    const FitCurve& curve = input.curves[i];
    Answer answer;
    if (first != nullptr && i < first->answers_.size()) answer.press = first->answers_[i].press;
    for (std::size_t j = 0; j < i && !answer.press; ++j)
      if (same_lattice(input.curves[j], curve)) answer.press = answers_[j].press;
    if (!answer.press) answer.press = std::make_shared<Press>(input, i, folder, context, go_on);
    answers_.push_back(std::move(answer));
    if (curve.travel)
      answers_.back().rig = behind_rig(input, i, curve.travel->rig, curve,
                                       Eigen::Index(input.options.free.size()), input.branches);
  }
}

std::vector<ForwardModel*> FitModels::addresses() const {
  std::vector<ForwardModel*> result;
  for (const Answer& each : answers_)
    result.push_back(each.rig ? static_cast<ForwardModel*>(each.rig.get()) : each.press.get());
  return result;
}

std::unique_ptr<calibration::RigModel> FitModels::behind_rig(
    const FitInput& input, std::size_t i, const calibration::Rig& rig,
    const calibration::Curve& curve, Eigen::Index parameters,
    const std::vector<calibration::FitBranch>& branches) const {
  return std::make_unique<calibration::RigModel>(
      *answers_[i].press, input.curves[i].press.protocol.samples,
      Eigen::Index(material_parameters(input)), rig, curve.x, curve.time, parameters, branches);
}

ForwardModel& FitModels::press(std::size_t i) const {
  return *answers_[i].press;
}

Eigen::VectorXd FitModels::press_forces(std::size_t i, const Eigen::VectorXd& rubber) const {
  return answers_[i].press->evaluate(rubber).value;
}

std::vector<double> FitModels::indentations(std::size_t i,
                                            const Eigen::VectorXd& parameters) const {
  calibration::RigModel* rig = answers_[i].rig.get();
  if (rig == nullptr) return {};
  rig->evaluate(parameters);
  return {rig->indentation().begin(), rig->indentation().end()};
}

void start_from_data(FitInput& input, const FitModels& models) {
  if (!has_travels(input))
    return start_from_data(input, curves_of(input), models.addresses(), input.options);
  std::vector<calibration::Curve> curves;
  std::vector<std::unique_ptr<calibration::RigModel>> presses;
  std::vector<ForwardModel*> list;
  CurveFitOptions options = input.options;
  const std::size_t count = material_parameters(input);
  options.free.resize(count);
  options.model_covariance = {};
  options.progress = input.options.progress;
  for (std::size_t i = 0; i < input.curves.size(); ++i) {
    const calibration::Curve curve = over_indentation(input.curves[i], start_of(input.options));
    if (curve.x.size() < 2) continue;
    curves.push_back(curve);
    presses.push_back(
        models.behind_rig(input, i, {}, curve, Eigen::Index(count),
                          calibration::held_at(input.branches, start_of(input.options))));
    list.push_back(presses.back().get());
  }
  if (curves.empty()) return;
  start_from_data(input, curves, list, options);
  std::ranges::copy(options.free, input.options.free.begin());
  const Eigen::VectorXd whole = start_of(input.options);
  for (const auto starts : {&CurveFitOptions::other_starts, &CurveFitOptions::reserve_starts})
    for (const Eigen::VectorXd& other : options.*starts)
      (input.options.*starts).emplace_back(whole).head(Eigen::Index(count)) = other;
  add_starts_in_time(input);
}

}  // namespace fingertip::studies::inline fits::inline models
