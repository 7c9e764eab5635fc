#include "studies/run/jobs.h"

#include "calibration/cube_test.h"
#include "calibration/result_io.h"
#include "meshes/json_fields.h"
#include "meshes/table_rows.h"
#include "source_hash.h"
#include "studies/files/run_tables.h"
#include "studies/run/fem_process.h"
#include "studies/run/json_file.h"
#include "studies/run/provenance.h"
#include "studies/run/static_press_job.h"

namespace fingertip::studies {

namespace {

using lattice::ModelKind;
using nlohmann::ordered_json;
namespace fs = std::filesystem;

void run_moduli(const meshes::Rubber& rubber, const calibration::ModuliFitOptions& options,
                const fs::path& folder, const JobContext& context) {
  context.report(0.0, "least squares");
  const calibration::ModuliFit fit = calibration::fit_moduli(rubber, options);
  calibration::write_calibration_json(fit, folder / "calibration.json");
  calibration::Material material = calibration::material_from(fit);
  material.program = "fingertip " + program_version();
  material.date = utc_now();
  calibration::write_material_toml(material, folder / "material.toml");
  const ModuliSummary summary{std::string(lattice::name(fit.model)),
                              "finished",
                              fit.spacing,
                              constants_entry(fit.constants),
                              moduli_entry(fit.achieved),
                              fit.iterations,
                              fit.statement};
  meshes::write_json_file(summary, folder / "summary.json");
  context.log(fit.statement);
}

void run_cubes(const meshes::Rubber& rubber, const lattice::SpringConstants& central,
               const lattice::SpringConstants& hookean, double spacing, const fs::path& folder,
               const JobContext& context) {
  const std::vector<std::pair<ModelKind, lattice::SpringConstants>> models = {
      {ModelKind::published, lattice::published_constants(rubber, spacing)},
      {ModelKind::central, central},
      {ModelKind::hookean, hookean}};
  std::vector<CubeRow> rows;
  double done = 0.0;
  for (const auto& [model, constants] : models) {
    for (const int cells : {2, 4, 8}) {
      const std::string stage =
          std::string(lattice::name(model)) + ", cells " + std::to_string(cells);
      if (!context.report(done / 9.0, stage)) throw meshes::Interrupted("cube tests stopped");
      const calibration::CubeModuli cube =
          calibration::measure_cube(lattice::cube_lattice(model, constants, spacing, cells));
      rows.push_back({std::string(lattice::name(model)), cells, cube.youngs_modulus_100,
                      cube.youngs_modulus_110, cube.youngs_modulus_111, cube.shear_modulus,
                      cube.poissons_ratio_100, cube.bulk_modulus});
      done += 1.0;
    }
  }
  meshes::write_rows(rows, folder / "cubes.csv");
}

/// Of a lateral motion that follows the press; nothing where none does.
void add_sliding(ordered_json& inputs, const meshes::PressProtocol& protocol) {
  if (!protocol.slides_after()) return;
  inputs["lateral_path"] = meshes::name(protocol.lateral_path);
  inputs["lateral_samples"] = protocol.lateral_samples;
}

/// Only what the result depends on: neither mass nor damping enters an equilibrium, no press enters
/// the natural frequencies.
ordered_json inputs_of(const fem_reference::ReferenceJob& order) {
  using fem_reference::Analysis;
  const bool has_press =
      order.analysis == Analysis::static_press || order.analysis == Analysis::transient;
  ordered_json inputs = {{"analysis", fem_reference::name(order.analysis)},
                         {"geometry", to_json(order.geometry)},
                         {"rubber", to_json(order.rubber)},
                         {"strain", fem_reference::name(order.strain)},
                         {"degree", order.degree},
                         {"volumetric", fem_reference::name(order.volumetric)},
                         {"refinement", order.refinement},
                         {"tolerance", order.tolerance},
                         {"max_unknowns", order.max_unknowns},
                         {"solver", fem_reference::name(order.solver)},
                         {"solver_tolerance", order.solver_tolerance},
                         {"fields", order.write_fields},
                         {"estimate_error", order.estimate_error}};
  if (order.strain == fem_reference::Strain::finite) inputs["law"] = fem_reference::name(order.law);
  if (order.analysis == Analysis::static_press) {
    inputs["rubber"].erase("density");
    inputs["rubber"].erase("retardation_time");
  }
  if (order.analysis == Analysis::modes) {
    inputs["rubber"].erase("retardation_time");
    inputs["modes"] = order.modes;
  }
  if (order.analysis == Analysis::transient) inputs["speed"] = order.speed;
  if (has_press) {
    inputs["contact"] = meshes::name(order.contact);
    inputs["tilt"] = order.tilt;
    inputs["lateral"] = order.lateral;
    add_sliding(inputs, order.protocol());
    inputs["samples"] = order.samples;
    if (order.contact == meshes::ContactMode::coulomb) inputs["friction"] = order.friction;
  }
  return inputs;
}

}  // namespace

ordered_json to_json(const meshes::Geometry& geometry) {
  return {{"tip_radius", geometry.tip_radius},
          {"rod_radius", geometry.rod_radius},
          {"sleeve_length", geometry.sleeve_length},
          {"rod_length", geometry.rod_length}};
}

ordered_json to_json(const meshes::Rubber& rubber) {
  return {{"youngs_modulus", rubber.youngs_modulus},
          {"shear_modulus", rubber.shear_modulus},
          {"density", rubber.density},
          {"retardation_time", rubber.retardation_time}};
}

ordered_json to_json(const meshes::PressProtocol& protocol) {
  ordered_json json = {{"mode", meshes::name(protocol.mode)},
                       {"contact", meshes::name(protocol.contact)},
                       {"depth", protocol.depth},
                       {"tilt", protocol.tilt},
                       {"lateral", protocol.lateral}};
  add_sliding(json, protocol);
  if (protocol.contact == meshes::ContactMode::coulomb) json["friction"] = protocol.friction;
  if (protocol.mode != meshes::DriveMode::equilibrium) {
    json["speed"] = protocol.speed;
    json["clearance"] = protocol.clearance;
  }
  json["samples"] = protocol.samples;
  return json;
}

ordered_json to_json(const lattice::PressSetup& setup) {
  return {{"geometry", to_json(setup.geometry)},
          {"rubber", to_json(setup.rubber)},
          {"protocol", to_json(setup.protocol)},
          {"lattice", to_json(setup.lattice)}};
}

ordered_json to_json(const lattice::LatticeSettings& settings) {
  ordered_json json = {
      {"model", lattice::name(settings.model)},
      {"kinematics", lattice::name(settings.kinematics)},
      {"spacing", settings.spacing},
      {"offset", std::vector<double>(settings.offset.begin(), settings.offset.end())},
      {"constants", to_json(settings.constants)},
      {"ligament_stiffness", settings.ligament_stiffness}};
  if (settings.contact_stiffness != 1.0) json["contact_stiffness"] = settings.contact_stiffness;
  if (!settings.axes.isIdentity(0.0))
    json["axes"] = std::vector<double>(settings.axes.data(), settings.axes.data() + 9);
  return json;
}

ordered_json to_json(const lattice::SpringConstants& constants) {
  return {
      {"k1", constants.k1}, {"k2", constants.k2}, {"k3", constants.k3}, {"kappa", constants.kappa}};
}

Job reference_job(const fem_reference::ReferenceJob& order) {
  Job job;
  job.kind = "reference";
  job.inputs = inputs_of(order);
  job.source_hash = source_hash::reference;
  job.weight = 40.0;
  job.resumable = true;
  job.run = [order](const fs::path& folder, const JobContext& context) {
    fem_reference::write_job(order, folder / "job.json");
    run_fem_process(reference_program(), folder, context);
    fs::remove_all(folder / "checkpoint");  // of use to an unfinished job alone
  };
  return job;
}

Job verification_job() {
  fem_reference::ReferenceJob order;
  order.analysis = fem_reference::Analysis::verification;
  Job job = reference_job(order);
  job.kind = "verification";
  return job;
}

Job moduli_job(const meshes::Rubber& rubber, const calibration::ModuliFitOptions& options) {
  Job job;
  job.kind = "moduli";
  job.inputs = {{"rubber", to_json(rubber)},
                {"model", lattice::name(options.model)},
                {"spacing", options.spacing},
                {"starts", options.starts},
                {"seed", options.seed},
                {"isotropy_weight", options.isotropy_weight},
                {"bulk_weight", options.bulk_weight}};
  job.source_hash = source_hash::calibration;
  job.weight = 0.1;
  job.run = [rubber, options](const fs::path& folder, const JobContext& context) {
    run_moduli(rubber, options, folder, context);
  };
  return job;
}

Job cubes_job(const meshes::Rubber& rubber, const lattice::SpringConstants& central,
              const lattice::SpringConstants& hookean, double spacing) {
  Job job;
  job.kind = "cubes";
  job.inputs = {{"rubber", to_json(rubber)},
                {"central", to_json(central)},
                {"hookean", to_json(hookean)},
                {"spacing", spacing}};
  job.source_hash = source_hash::calibration;
  job.weight = 1.0;
  job.run = [=](const fs::path& folder, const JobContext& context) {
    run_cubes(rubber, central, hookean, spacing, folder, context);
  };
  return job;
}

}  // namespace fingertip::studies
