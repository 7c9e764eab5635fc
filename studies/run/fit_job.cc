#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "calibration/curves/curve_checks.h"
#include "calibration/curves/damping_models.h"
#include "calibration/curves/model_error.h"
#include "calibration/curves/remembered_model.h"
#include "calibration/curves/stretch_models.h"
#include "lattice/press/setup_fields.h"
#include "lattice/press/static_press.h"
#include "meshes/fields_json.h"
#include "source_hash.h"
#include "studies/run/continuum_model.h"
#include "studies/run/digest.h"
#include "studies/run/fit_material.h"
#include "studies/run/jobs.h"
#include "studies/run/json_file.h"

namespace fingertip::studies {

using calibration::CurveFitOptions;
using calibration::ForwardModel;
using calibration::MaterialParameter;
using nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

/// What the answers for a curve depend on, and its data.
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
  if (input.kinds[i] == CurveKind::continuum)
    inputs["continuum"] = reference_job(input.continua[i]).key();
  // The ramp's lattice is static, its rubber's damping is not.
  if (input.kinds[i] == CurveKind::ramp) inputs["speed"] = input.presses[i].protocol.speed;
  return inputs;
}

/// The stiffness of a ramp errs by the square of the samples' distance.
constexpr int ramp_samples = 40;

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
          input.continua[i], parameters, fmt::format("continuum_{}", i + 1), context));
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

/// Models, and what remembers their answers in the folder's evaluations/.
class Models {
 public:
  Models(const FitInput& input, const fs::path& folder, const JobContext& context,
         const std::function<bool()>& go_on) {
    fs::create_directories(folder / "evaluations");
    for (std::size_t i = 0; i < input.curves.size(); ++i) {
      models_.push_back(model_of(input, i, context, go_on));
      remembering_.push_back(std::make_unique<calibration::RememberedModel>(
          *models_[i], folder / "evaluations" / fmt::format("curve_{}.jsonl", i + 1),
          Eigen::Index(input.curves[i].x.size()), Eigen::Index(input.options.free.size()),
          sha256(curve_inputs(input, i).dump())));
    }
  }

  std::vector<ForwardModel*> addresses() const {
    std::vector<ForwardModel*> result;
    for (const auto& model : remembering_) result.push_back(model.get());
    return result;
  }

 private:
  std::vector<std::unique_ptr<ForwardModel>> models_;
  std::vector<std::unique_ptr<calibration::RememberedModel>> remembering_;
};

/// Points per parameter where an evaluation costs nothing: valleys are narrow.
constexpr int fine_grid = 61;

void add_profile(const FitInput& input, const std::vector<ForwardModel*>& models,
                 calibration::FitRecord& record) {
  const auto place = [&](const std::string& name) {
    const auto found = std::ranges::find_if(record.fit.parameters, [&](MaterialParameter each) {
      return calibration::name(each) == name;
    });
    return std::size_t(found - record.fit.parameters.begin());
  };
  const std::size_t first = place(input.profile[0]), second = place(input.profile[1]);
  calibration::ProfileOptions grid;
  if (input.presses.empty() || by_continuum(input)) grid.points = fine_grid;
  record.profile = calibration::profile_likelihood(record.curves, models, record.options,
                                                   record.fit, first, second, grid);
  record.profile_first = record.fit.parameters[first];
  record.profile_second = record.fit.parameters[second];
}

void write(const calibration::FitRecord& record, const fs::path& folder) {
  const std::vector<std::string> failed = calibration::failed_tests(record);
  calibration::write_fit_json(record, folder / "calibration.json");
  calibration::write_fit_data(record, folder / "fit_data.csv");
  calibration::Material material = record.material;
  material.statement = calibration::fit_statement(record);
  for (const std::string& reason : failed)
    material.rejected += (material.rejected.empty() ? "" : "; ") + reason;
  if (material.violations().empty())
    calibration::write_material_toml(material, folder / estimates_name);
  write_json({{"problem", record.problem},
              {"model", lattice::name(record.material.model)},
              {"status", "finished"},
              {"failed", failed},
              {"evaluations", record.fit.evaluations},
              {"wall_time", record.wall_time},
              {"statement", material.statement}},
             folder / "summary.json");
}

std::string model_error_words(const FitInput& input) {
  std::string words = input.with_lattice_error ? "the known error of the lattice" : "";
  if (!input.theory_error.empty())
    words += std::string(words.empty() ? "" : " and ") + input.theory_error_of;
  return words;
}

calibration::FitRecord described(const FitInput& input) {
  calibration::FitRecord record;
  record.problem = name(input.problem);
  record.forward = by_continuum(input)     ? "continuum"
                   : input.presses.empty() ? "formula"
                                           : "lattice";
  record.curves = input.curves;
  record.conditions = input.conditions;
  record.model_error = model_error_words(input);
  if (input.rubber_known) record.target = input.base.rubber;
  return record;
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
void start_from_data(FitInput& input, const std::vector<ForwardModel*>& models) {
  CurveFitOptions& options = input.options;
  if (!input.start_ratios.empty()) {
    std::vector<Eigen::VectorXd> starts =
        calibration::scaled_starts(input.curves, models, options, input.start_ratios);
    if (starts.empty()) return;
    start_at(starts.front(), options);
    options.other_starts.assign(starts.begin() + 1, starts.end());
  } else if (input.scale_to_data) {
    if (const auto start = calibration::scaled_start(input.curves, models, options))
      start_at(*start, options);
  }
}

/// Relative errors of all values times `forces`.
void put_model_error(FitInput& input, const Eigen::VectorXd& forces) {
  Eigen::MatrixXd& covariance = input.options.model_covariance;
  const Eigen::Index count = forces.size();
  covariance = input.with_lattice_error ? calibration::lattice_covariance(input.presses)
                                        : Eigen::MatrixXd::Zero(count, count);
  std::vector<double> theory;
  for (const std::vector<double>& curve : input.theory_error)
    theory.insert(theory.end(), curve.begin(), curve.end());
  if (!theory.empty()) {
    const auto excess = Eigen::VectorXd::Map(theory.data(), count);
    covariance += excess * excess.transpose();
  }
  covariance = forces.asDiagonal() * covariance * forces.asDiagonal();
  // What is known of the models stands in the covariance: intervals alone tell what is open.
  input.options.relative_singular_value = 0.0;
}

Eigen::VectorXd measured_values(const FitInput& input) {
  std::vector<double> all;
  for (const calibration::Curve& curve : input.curves)
    all.insert(all.end(), curve.y.begin(), curve.y.end());
  return Eigen::VectorXd::Map(all.data(), Eigen::Index(all.size()));
}

Eigen::VectorXd values_at_start(const FitInput& input, const std::vector<ForwardModel*>& models) {
  Eigen::VectorXd start(Eigen::Index(input.options.free.size()));
  for (Eigen::Index i = 0; i < start.size(); ++i)
    start(i) = input.options.free[std::size_t(i)].start;
  Eigen::VectorXd all(measured_values(input).size());
  Eigen::Index row = 0;
  for (ForwardModel* model : models) {
    const Eigen::VectorXd values = model->evaluate(start).value;
    all.segment(row, values.size()) = values;
    row += values.size();
  }
  return all;
}

/// From starts at the data's scale, every force as uncertain as noise and the known errors of its
/// model make it. Errors are relative to forces: at first to those measured, then, lest noise weigh
/// itself, to those of the start.
calibration::CurveFit search(FitInput& input, const std::vector<ForwardModel*>& models) {
  const bool errors = input.with_lattice_error || !input.theory_error.empty();
  if (errors) put_model_error(input, measured_values(input));
  start_from_data(input, models);
  if (errors) put_model_error(input, values_at_start(input, models));
  return calibration::fit_curves(input.curves, models, input.options);
}

void run_fit(FitInput input, const fs::path& folder, const JobContext& context) {
  const auto begin = std::chrono::steady_clock::now();
  const int budget = input.options.max_evaluations;
  std::string stage = "scan of starts";
  int evaluations = 0;
  const auto go_on = [&] {
    return context.report(
        std::min(1.0, double(evaluations) / budget),
        fmt::format("{}: {} of at most {} evaluations", stage, evaluations, budget));
  };
  const Models models(input, folder, context, go_on);
  const std::vector<ForwardModel*> list = models.addresses();
  input.options.threads = context.threads;
  input.options.progress = [&](int count, double) {
    evaluations = count;
    return go_on();
  };

  calibration::FitRecord record = described(input);
  record.fit = search(input, list);
  record.options = input.options;
  stage = "curves left out";
  if (input.curves.size() > 1)
    record.left_out = calibration::leave_one_out(input.curves, list, record.options, record.fit);
  stage = "profile";
  if (!input.profile.empty()) add_profile(input, list, record);
  record.material = material_of(input, record);
  record.wall_time =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  write(record, folder);
  context.log(calibration::fit_statement(record));
}

ordered_json inputs_of(const FitInput& input) {
  ordered_json inputs = {
      {"problem", name(input.problem)},
      {"geometry", meshes::json_of(input.base.geometry)},
      {"rubber", rubber_inputs(input.base.rubber, input.base.lattice.kinematics)},
      {"lattice", meshes::json_of(input.base.lattice)},
      {"rubber_known", input.rubber_known},
      {"robust_width", input.options.robust_width},
      {"starts", input.start_ratios},
      {"profile", input.profile},
      {"scale_to_data", input.scale_to_data},
      {"lattice_error", input.with_lattice_error},
      {"theory_error", input.theory_error},
      {"evaluations", input.options.max_evaluations},
      {"poissons_ratios",
       {input.options.lowest_poissons_ratio, input.options.highest_poissons_ratio}},
      {"known", {input.density_known, input.retardation_time_known}},
      {"provenance", input.provenance}};
  inputs["curves"] = inputs["free"] = ordered_json::array();
  for (std::size_t i = 0; i < input.curves.size(); ++i)
    inputs["curves"].push_back(curve_inputs(input, i));
  for (const calibration::FreeParameter& free : input.options.free)
    inputs["free"].push_back({{"name", calibration::name(free.parameter)},
                              {"start", free.start},
                              {"scale", free.scale},
                              {"lower", free.lower},
                              {"upper", free.upper},
                              {"prior", free.prior ? free.prior->deviation : 0.0}});
  return inputs;
}

}  // namespace

bool by_continuum(const FitInput& input) {
  return !input.kinds.empty() && input.kinds.front() == CurveKind::continuum;
}

std::vector<MaterialParameter> parameters_of(const FitInput& input) {
  std::vector<MaterialParameter> parameters;
  for (const auto& free : input.options.free) parameters.push_back(free.parameter);
  return parameters;
}

Job fit_job(const FitInput& input) {
  Job job;
  job.kind = "fit";
  job.inputs = inputs_of(input);
  job.source_hash = source_hash::calibration;
  job.weight = fit_weight;
  job.resumable = true;
  job.run = [input](const fs::path& folder, const JobContext& context) {
    run_fit(input, folder, context);
  };
  return job;
}

}  // namespace fingertip::studies
