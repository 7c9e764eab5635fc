#include "studies/fits/runs/displacement_job.h"

#include <fmt/format.h>

#include <functional>

#include "lattice/model/constants.h"
#include "lattice/press/static_press.h"
#include "meshes/press/markers.h"
#include "meshes/tables/fields_json.h"
#include "meshes/tables/table_rows.h"
#include "source_hash.h"
#include "studies/fits/models/continuum_model.h"
#include "studies/fits/runs/displacement_study.h"
#include "studies/presses/press_record.h"
#include "studies/presses/reference_job.h"

namespace fingertip::studies::inline fits::inline runs {

namespace {

namespace fs = std::filesystem;
using calibration::DisplacementMoments;
using lattice::ModelKind;
using nlohmann::ordered_json;

/// The lattice's displacements at a Poisson's ratio.
std::vector<meshes::MarkerRow> pressed_at(lattice::PressSetup setup, double poissons_ratio,
                                          const std::function<bool()>& go_on) {
  meshes::Rubber& rubber = setup.rubber;
  rubber.youngs_modulus = 2.0 * rubber.shear_modulus * (1.0 + poissons_ratio);
  if (setup.lattice.model == ModelKind::hookean)
    setup.lattice.constants = lattice::hookean_constants(rubber, setup.lattice.spacing);
  return lattice::run_static_press(setup,
                                   [&](const lattice::StaticOutcome&, double) { return go_on(); })
      .markers;
}

/// Of a press at each of the ratios.
std::vector<MarkerFields> fields_at(const DisplacementFitInput& input,
                                    const std::vector<double>& ratios, const JobContext& context) {
  std::vector<MarkerFields> fields;
  std::vector<PlannedJob> jobs;
  for (const double nu : ratios) {
    if (input.by_lattice)
      fields.push_back(
          fields_of(pressed_at(input.press, nu,
                               [&] { return context.report(0.0, fmt::format("nu {:.4f}", nu)); }),
                    input.measured));
    else
      jobs.push_back({fmt::format("{}/{:.6f}", input.place, nu),
                      reference_job(at_ratio(input.continuum, nu))});
  }
  if (jobs.empty()) return fields;
  for (const fs::path& folder : context.run_all(jobs))
    fields.push_back(
        fields_of(meshes::read_rows<meshes::MarkerRow>(folder / "markers.csv"), input.measured));
  return fields;
}

calibration::ScaledModel::Solver solver_of(const DisplacementFitInput& input,
                                           const DisplacementMoments& moments,
                                           const JobContext& context) {
  return [&](const std::vector<double>& ratios) {
    std::vector<Eigen::VectorXd> answers;
    for (const MarkerFields& fields : fields_at(input, ratios, context))
      answers.push_back(moments.of(fields));
    return answers;
  };
}

/// What the fit computes: the press that sticks, on its way to that which slips, times its factor.
MarkerFields fitted_fields(const DisplacementFitInput& input, const DisplacementFitInput& slipping,
                           const calibration::DisplacementFitFile& fit, const JobContext& context) {
  MarkerFields fields = fields_at(input, {fit.poissons_ratio}, context).front();
  MarkerFields free;
  if (input.freed.slip) free = fields_at(slipping, {fit.poissons_ratio}, context).front();
  for (std::size_t s = 0; s < fields.size(); ++s)
    for (std::size_t i = 0; i < fields[s].size(); ++i) {
      meshes::Vector3& own = fields[s][i];
      const meshes::Vector3 stuck = own;
      own *= fit.loads[s].stretch;
      if (!free.empty()) own += fit.loads[s].slip * (free[s].at(i) - stuck);
    }
  return fields;
}

bool is_finite(const DisplacementFitInput& input) {
  return input.by_lattice ? input.press.lattice.kinematics == lattice::Kinematics::finite
                          : input.continuum.strain == fem_reference::Strain::finite;
}

void run_displacements(const DisplacementFitInput& input, const fs::path& folder,
                       const JobContext& context) {
  const DisplacementFile& measured = input.measured;
  const DisplacementMoments moments(measured.places, measured.samples, input.frame);
  DisplacementFitInput free = input;
  free.press.protocol.contact = free.continuum.protocol.contact = meshes::ContactMode::frictionless;
  free.place += "_frictionless";
  calibration::DisplacementModel model(solver_of(input, moments, context), 0.0),
      slipping(solver_of(free, moments, context), 0.0);
  calibration::DisplacementFitFile fit = calibration::fit_poissons_ratio(
      moments, measured.samples, model, &slipping, input.frame, input.freed);
  fit.data = measured.name;
  fit.model =
      input.by_lattice ? std::string(lattice::name(input.press.lattice.model)) : "continuum";
  fit.strain = is_finite(input) ? "finite" : "small";
  const MarkerFields fields = fitted_fields(input, free, fit, context);
  const auto distances = distances_of(measured, fields);
  const std::string name = input.by_lattice ? fit.model : "continuum, " + fit.strain + " strain";
  meshes::write_rows(rows_of(measured, distances, fields, name), folder / "displacements.csv");
  meshes::write_json_file(
      DisplacementStudy{entries_of(measured, distances, name),
                        scatter_at_rest(measured),
                        {ratio_entry(fit, measured.name, folder.filename().string())}},
      folder / "distances.json");
  meshes::write_json_file(fit, folder / "displacements.json");
  meshes::write_json_file(
      {{"status", "finished"}, {"failed", fit.failed}, {"statement", fit.statement}},
      folder / "summary.json");
  context.log(fit.statement);
}

ordered_json displacement_inputs(const DisplacementFitInput& input) {
  ordered_json inputs = {{"sha256", input.measured.sha256},
                         {"frame", int(input.frame)},
                         {"freed", {input.freed.compression, input.freed.slip}}};
  const auto list = [](const std::vector<meshes::Vector3>& points) {
    ordered_json all = ordered_json::array();
    for (const meshes::Vector3& at : points) all.push_back({at.x(), at.y(), at.z()});
    return all;
  };
  inputs["places"] = list(input.measured.places);
  for (const calibration::MeasuredDisplacements& load : input.measured.samples)
    inputs["loads"].push_back({load.indentation, list(load.displacement)});
  if (input.by_lattice)
    inputs["press"] = inputs_of(input.press);
  else
    inputs["continuum"] = reference_job(input.continuum).key();
  return inputs;
}

}  // namespace

Job displacement_job(const DisplacementFitInput& input) {
  const ModelKind model = input.press.lattice.model;
  if (input.by_lattice && model != ModelKind::hookean && model != ModelKind::network)
    throw meshes::InvalidInput({"lattice.model", std::string(lattice::name(model)),
                                "does not hold any Poisson's ratio",
                                "choose hookean or network, or the continuum"});
  return {.kind = "displacements",
          .inputs = displacement_inputs(input),
          .source_hash = source_hash::calibration,
          .run = std::bind_front(run_displacements, input),
          .weight = fit_weight};
}

}  // namespace fingertip::studies::inline fits::inline runs
