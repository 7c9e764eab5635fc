#include "studies/fits/runs/fit_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>

#include "calibration/files/words.h"
#include "calibration/moduli/moduli_fit.h"
#include "calibration/press_fit/lattice_forward_model.h"
#include "calibration/press_fit/model_error.h"
#include "calibration/statistics/curve_checks.h"
#include "calibration/statistics/curve_fit.h"
#include "calibration/statistics/fit_statistics.h"
#include "lattice/model/constants.h"
#include "lattice/press/setup_fields.h"
#include "meshes/press/fields.h"
#include "meshes/tables/fields_json.h"
#include "source_hash.h"
#include "studies/fits/models/described_numbers.h"
#include "studies/fits/models/fit_models.h"
#include "studies/fits/models/fit_relaxation.h"
#include "studies/fits/models/fit_repeats.h"
#include "studies/fits/models/fit_rig.h"
#include "studies/fits/models/held_back.h"
#include "studies/fits/models/measurement_gains.h"
#include "studies/fits/models/omitted_effects.h"
#include "studies/fits/models/rivals.h"
#include "studies/presses/press_record.h"

namespace fingertip::studies::inline fits::inline runs {

using calibration::CurveFitOptions;
using calibration::ForwardModel;
using calibration::MaterialParameter;
using nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

/// Points per parameter where an evaluation costs nothing: valleys are narrow.
constexpr int fine_grid = 61, coarse_grid = 9;

void add_profile(const FitInput& input, const std::vector<ForwardModel*>& models,
                 calibration::FitRecord& record) {
  const auto place = [&](const std::string& name) {
    return std::size_t(std::ranges::find(record.fit.labels, name) - record.fit.labels.begin());
  };
  const std::size_t first = place(input.profile[0]), second = place(input.profile[1]);
  const int points = !has_presses(input) || by_continuum(input) ? fine_grid : coarse_grid;
  record.profile = calibration::profile_likelihood(record.curves, models, record.options,
                                                   record.fit, first, second, points);
  record.profile_first = record.fit.parameters[first];
  record.profile_second = record.fit.parameters[second];
}

/// Of another rubber than the setup's: its constants in closed form.
void put_rubber(const meshes::Rubber& rubber, lattice::PressSetup& setup) {
  setup.rubber = rubber;
  calibration::ModuliFitOptions options;
  options.model = setup.lattice.model;
  options.spacing = setup.lattice.spacing;
  setup.lattice.constants = options.model == lattice::ModelKind::central
                                ? calibration::fit_moduli(rubber, options).constants
                                : lattice::hookean_constants(rubber, options.spacing);
}

/// The lattice and rubber that the estimates stand for.
lattice::PressSetup fitted_setup(const FitInput& input, const Eigen::VectorXd& estimates) {
  lattice::PressSetup setup = input.base;
  if (input.problem == CalibrationProblem::damping) {
    setup.rubber.retardation_time = estimates(0);
  } else if (by_continuum(input)) {
    put_rubber(calibration::with_moduli(input.base.rubber, parameters_of(input), estimates), setup);
  } else {
    return calibration::LatticeForwardModel(setup, parameters_of(input)).setup_with(estimates);
  }
  return setup;
}

calibration::Validity validity_of(const FitInput& input, const calibration::FitRecord& record) {
  calibration::Validity validity;
  if (!has_presses(input)) return validity;
  const lattice::PressSetup& press =
      std::ranges::max_element(input.curves, {}, [](const FitCurve& curve) {
        return curve.press.protocol.samples.back() / curve.press.geometry.thickness();
      })->press;
  validity.largest_indentation = press.protocol.samples.back();
  validity.thickness = press.geometry.thickness();
  if (press.geometry.is_dome())
    validity.rod_ratio = press.geometry.rod_radius / press.geometry.tip_radius;
  // Of what a lattice makes of the rubber a fit of the continuum knows nothing.
  if (!by_continuum(input)) {
    validity.smallest_spacing = validity.largest_spacing = press.lattice.spacing;
    validity.model_error = calibration::worst_relative_residual(record);
  }
  for (const FitCurve& curve : input.curves)
    if (const auto contact = curve.press.protocol.contact;
        std::ranges::find(validity.contacts, contact) == validity.contacts.end())
      validity.contacts.push_back(contact);
  return validity;
}

/// The lattice and rubber that the estimates stand for, and where they hold.
calibration::Material material_of(const FitInput& input, const calibration::FitRecord& record) {
  const lattice::PressSetup setup = fitted_setup(input, record.fit.estimates);
  calibration::Material material;
  material.model = setup.lattice.model;
  material.kinematics = setup.lattice.kinematics;
  material.spacing = setup.lattice.spacing;
  material.constants = setup.lattice.constants;
  material.rubber = setup.rubber;
  material.rubber.relaxation = relaxation_of(input, record.fit.estimates);
  if (setup.geometry.is_dome()) material.geometry = setup.geometry;
  material.density_known = input.density_known;
  material.retardation_time_known =
      input.retardation_time_known || input.problem == CalibrationProblem::damping;
  material.ligament_stiffness = setup.lattice.ligament_stiffness;
  material.contact_stiffness = setup.lattice.contact_stiffness;
  material.validity = validity_of(input, record);
  material.provenance = input.provenance;
  material.program = input.program;
  return material;
}

void write(const calibration::FitRecord& record, const fs::path& folder) {
  const std::vector<std::string> failed = calibration::failed_tests(record);
  calibration::write_fit_json(record, folder / "calibration.json");
  calibration::write_fit_data(record, folder / "fit_data.csv");
  calibration::Material material = record.material;
  material.statement = calibration::fit_statement(record);
  material.rejected = calibration::in_one(failed);
  if (material.violations().empty())
    calibration::write_material_toml(material, folder / estimates_name);
  meshes::write_json_file({{"problem", record.problem},
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
  for (const KnownError& error : input.known_errors) {
    const std::string named = error.number ? "the tolerance of " + error.name : error.name;
    // One number of several fingers is an error of each.
    if (words.find(named) == words.npos) words += std::string(words.empty() ? "" : " and ") + named;
  }
  return words;
}

calibration::FitRecord described(const FitInput& input) {
  calibration::FitRecord record;
  record.problem = name(input.problem);
  record.forward = by_continuum(input) ? "continuum" : has_presses(input) ? "lattice" : "formula";
  record.curves = curves_of(input);
  for (const FitCurve& curve : input.curves) record.conditions.push_back(curve.condition);
  record.model_error = model_error_words(input);
  if (!input.branches.empty()) record.observed_times = observed_times(input.curves);
  if (input.rubber_known) record.target = input.base.rubber;
  return record;
}

/// Relative errors of all values times `forces`.
void put_model_error(FitInput& input, const Eigen::VectorXd& forces) {
  Eigen::MatrixXd& covariance = input.options.model_covariance;
  covariance = forces.asDiagonal() *
               relative_model_error(presses_of_values(input), input.with_lattice_error,
                                    known_errors_at_values(input)) *
               forces.asDiagonal();
  // What is known of the models stands in the covariance: intervals alone tell what is open.
  input.options.relative_singular_value = 0.0;
}

Eigen::VectorXd values_at_start(const FitInput& input, const std::vector<ForwardModel*>& models) {
  std::vector<Eigen::VectorXd> values;
  for (ForwardModel* model : models)
    values.push_back(model->evaluate(start_of(input.options)).value);
  return calibration::stacked(values);
}

/// From starts at the data's scale, every force as uncertain as noise and the known errors of its
/// model make it. Errors are relative to forces: at first to those measured, then, lest noise weigh
/// itself, to those of the start.
calibration::CurveFit search(FitInput& input, const FitModels& models) {
  const bool errors = input.with_lattice_error || !input.known_errors.empty();
  if (errors) put_model_error(input, calibration::all_values(input.curves));
  start_from_data(input, models);
  if (errors) put_model_error(input, values_at_start(input, models.addresses()));
  return calibration::fit_curves(curves_of(input), models.addresses(), input.options);
}

/// What errors of numbers that describe the presses do to the rubber's estimates. Where a force is
/// larger than the model's by c, an estimate is too large by what c in the data does to it.
std::vector<calibration::SensitivityEntry> sensitivities_of(const FitInput& input,
                                                            const calibration::FitRecord& record,
                                                            const JobContext& context) {
  std::vector<calibration::SensitivityEntry> entries;
  if (input.problem != CalibrationProblem::experiment || !has_presses(input)) return entries;
  const Eigen::VectorXd computed =
      calibration::all_values(record.curves) - calibration::stacked(record.fit.residuals);
  const ForceAndDepth at = presses_at(input, record.fit.estimates, computed);
  const auto add = [&](const KnownError& error, bool counts, const Eigen::VectorXd& relative) {
    calibration::SensitivityEntry& entry =
        entries.emplace_back(error.name, unit_of(*error.number), error.value, error.step, counts);
    for (std::size_t i = 0; i < material_parameters(input); ++i)
      entry.changes[record.fit.labels[i]] =
          -record.fit.influence.row(Eigen::Index(i)).dot(at.force.cwiseProduct(relative));
  };
  const Eigen::MatrixXd known = known_errors_at_values(input);
  for (std::size_t k = 0; k < input.known_errors.size(); ++k)
    if (input.known_errors[k].number) add(input.known_errors[k], true, known.col(Eigen::Index(k)));
  for (const KnownError& error : untold_numbers(input)) {
    try {
      std::vector<Eigen::VectorXd> changes;
      for (const FitCurve& curve : input.curves)
        changes.emplace_back(known_errors_at(curve, {changes_of(error, curve.press)},
                                             depths_of_values(curve, record.fit.estimates)));
      add(error, false, calibration::stacked(changes));
    } catch (const meshes::NotConverged& failure) {
      context.log("what an error of " + error.name + " does is not known: " + failure.what());
    }
  }
  return entries;
}

/// Of factors between repeats; 0: there are none.
double scatter_of(const calibration::FitRecord& record) {
  return record.errors && record.errors->scatter > 0.0 ? record.errors->scatter : 0.0;
}

void run_fit(FitInput input, const fs::path& folder, const JobContext& context) {
  const auto begin = std::chrono::steady_clock::now();
  const int budget = input.options.max_evaluations;
  std::string stage = "scan of starts";
  int evaluations = 0;
  const auto go_on = [&] {
    return context.report(
        std::min(1.0, double(evaluations) / budget),
        budget < std::numeric_limits<int>::max()
            ? fmt::format("{}: {} of at most {} evaluations", stage, evaluations, budget)
            : fmt::format("{}: {} evaluations", stage, evaluations));
  };
  const FitModels models(input, folder, context, go_on);
  const std::vector<ForwardModel*> list = models.addresses();
  input.options.threads = context.threads;
  input.options.progress = [&](int count, double) {
    evaluations = count;
    return go_on();
  };

  calibration::FitRecord record = described(input);
  record.fit = search(input, models);
  stage = "repeats and intervals";
  const calibration::CurveFit searched = record.fit;
  add_errors_and_intervals(input, list, record);
  record.sensitivities = sensitivities_of(input, record, context);
  stage = "what is told of the presses";
  record.rivals = rivals_of(input, models, searched, record, context.log);
  take_rivals(record);
  stage = "curves left out";
  if (input.curves.size() > 1)
    record.left_out = calibration::leave_one_out(record.curves, list, record.options, record.fit);
  stage = "profile";
  if (!input.profile.empty()) add_profile(input, list, record);
  stage = "lack of fit";
  record.lack_of_fit =
      score_tests_of(input, searched, input.options, models, scatter(record.repeats));
  accuse_rival(record);
  if (record.fit.converged && !input.candidates.empty())
    record.next =
        measurement_gains(input, models, record.fit.estimates,
                          record.errors ? record.errors->noise : record.fit.residual_deviation,
                          record.misfit_size, scatter_of(record), folder, context,
                          [&](double, const std::string& name) {
                            stage = "further measurement, " + name;
                            return go_on();
                          })
            .gains;
  record.predicted =
      predicted(input, models, record, folder, context, [&](const std::string& name) {
        stage = "press held back, " + name;
        return go_on();
      });
  record.rig = rig_values(input);
  for (std::size_t i = 0; has_travels(input) && i < input.curves.size(); ++i)
    record.indentation.push_back(models.indentations(i, record.fit.estimates));
  record.material = material_of(input, record);
  record.wall_time =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  write(record, folder);
  context.log(calibration::fit_statement(record));
}

/// What a fit or a plan depends on.
ordered_json fit_inputs(const FitInput& input) {
  ordered_json inputs = {
      {"problem", name(input.problem)},
      {"geometry", meshes::json_of(input.base.geometry)},
      {"rubber", rubber_inputs(input.base.rubber, input.base.lattice.kinematics)},
      {"lattice", meshes::json_of(input.base.lattice)},
      {"rubber_known", input.rubber_known},
      {"contact_told", input.contact_told},
      {"robust_width", input.options.robust_width},
      {"starts", input.start_ratios},
      {"profile", input.profile},
      {"profile_intervals", input.profile_intervals},
      {"scale_to_data", input.scale_to_data},
      {"lattice_error", input.with_lattice_error},
      {"evaluations", input.options.max_evaluations},
      {"poissons_ratios",
       {input.options.lowest_poissons_ratio, input.options.highest_poissons_ratio}},
      {"known", {input.density_known, input.retardation_time_known}},
      {"provenance", input.provenance}};
  inputs["curves"] = inputs["free"] = ordered_json::array();
  for (std::size_t i = 0; i < input.curves.size(); ++i)
    inputs["curves"].push_back(curve_inputs(input, i));
  for (const calibration::FreeParameter& free : input.options.free)
    inputs["free"].push_back({{"name", calibration::label(free)},
                              {"start", free.start},
                              {"scale", free.scale},
                              {"lower", free.lower},
                              {"upper", free.upper},
                              {"mean", free.prior ? free.prior->mean : 0.0},
                              {"prior", free.prior ? free.prior->deviation : 0.0}});
  // Held at the default or given as equal to it: the fit is the same, what is told of it is not.
  for (const calibration::RigValue& each : rig_values(input))
    inputs["rig_given"].push_back(each.given);
  for (const KnownError& each : input.known_errors)
    inputs["known_errors"].push_back({each.name, each.value, each.step, each.low, each.high});
  if (input.with_held_back)
    for (std::size_t i = input.curves.size(); i < input.with_held_back->curves.size(); ++i)
      inputs["held_back"].push_back(curve_inputs(*input.with_held_back, i));
  inputs["candidates"] = ordered_json::array();
  for (const Candidate& each : input.candidates) {
    inputs["candidates"].push_back({each.name, each.press, each.depth, each.refused});
    if (each.input) inputs["candidates"].back().push_back(curve_inputs(*each.input, 0));
  }
  return inputs;
}

}  // namespace

Job fit_job(const FitInput& input) {
  return {.kind = "fit",
          .inputs = fit_inputs(input),
          .source_hash = source_hash::calibration,
          .run = std::bind_front(run_fit, input),
          .weight = fit_weight,
          .resumable = true};
}

}  // namespace fingertip::studies::inline fits::inline runs
