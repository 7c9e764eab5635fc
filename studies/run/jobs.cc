#include "studies/run/jobs.h"

#include "calibration/cube_test.h"
#include "calibration/fit_statement.h"
#include "calibration/result_io.h"
#include "lattice/press/setup_fields.h"
#include "meshes/fields_json.h"
#include "meshes/table_rows.h"
#include "source_hash.h"
#include "studies/files/places.h"
#include "studies/files/run_tables.h"
#include "studies/run/fem_process.h"
#include "studies/run/json_file.h"
#include "studies/run/press_record.h"
#include "studies/run/provenance.h"

namespace fingertip::studies {

namespace {

using lattice::ModelKind;
using meshes::json_of;
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
                              calibration::fit_statement(fit)};
  meshes::write_json_file(summary, folder / "summary.json");
  context.log(summary.statement);
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

/// Neither mass nor damping enters an equilibrium, nor time unless the rubber relaxes; no press
/// enters the natural frequencies, which are those of the moduli after long times.
ordered_json inputs_of(const fem_reference::ReferenceJob& reference) {
  using fem_reference::Analysis;
  ordered_json inputs = json_of(reference);
  inputs["protocol"] = studies::inputs_of(reference.protocol, reference.in_time());
  drop(inputs["protocol"], {"mode"});
  // A program's rises, and with them its falls, are shorter than the clearance.
  if (reference.protocol.program.empty()) drop(inputs["protocol"], {"clearance"});
  if (reference.strain != fem_reference::Strain::finite || reference.analysis == Analysis::modes)
    drop(inputs["rubber"], {"energy"});
  if (reference.analysis != Analysis::modes) drop(inputs, {"modes"});
  if (!reference.axisymmetric() || !reference.write_fields) drop(inputs, {"field_sectors"});
  if (reference.analysis == Analysis::static_press)
    drop(inputs["rubber"], {"density", "retardation_time"});
  if (reference.analysis == Analysis::modes)
    drop(inputs["rubber"], {"retardation_time", "relaxation"});
  if (reference.analysis == Analysis::modes || reference.analysis == Analysis::verification)
    drop(inputs, {"protocol"});
  return inputs;
}

}  // namespace

Job reference_job(const fem_reference::ReferenceJob& reference) {
  Job job;
  job.kind = "reference";
  job.inputs = inputs_of(reference);
  job.source_hash = source_hash::reference;
  job.weight = reference.axisymmetric() ? meridian_weight : reference_weight;
  job.resumable = true;
  job.run = [reference](const fs::path& folder, const JobContext& context) {
    fem_reference::write_job(reference, folder / "job.json");
    JobContext own = context;
    if (reference.axisymmetric() && own.ranks > 1)
      own.log("a meridian is solved on one process: --ranks is not used");
    // Threads would wait for each other longer than its small fronts take.
    if (reference.axisymmetric()) own.ranks = own.threads = 1;
    run_fem_process(reference_program(), folder, own);
    fs::remove_all(folder / "checkpoint");  // of use to an unfinished job alone
  };
  return job;
}

Job verification_job() {
  fem_reference::ReferenceJob reference;
  reference.analysis = fem_reference::Analysis::verification;
  Job job = reference_job(reference);
  job.kind = "verification";
  return job;
}

Job moduli_job(const meshes::Rubber& rubber, const calibration::ModuliFitOptions& options) {
  Job job;
  job.kind = "moduli";
  job.inputs = {{"rubber", rubber_inputs(rubber, lattice::Kinematics::small)},
                {"model", lattice::name(options.model)},
                {"spacing", options.spacing},
                {"starts", options.starts},
                {"seed", options.seed},
                {"isotropy_weight", options.isotropy_weight},
                {"bulk_weight", options.bulk_weight}};
  job.source_hash = source_hash::calibration;
  job.weight = moduli_weight;
  job.run = [rubber, options](const fs::path& folder, const JobContext& context) {
    run_moduli(rubber, options, folder, context);
  };
  return job;
}

Job cubes_job(const meshes::Rubber& rubber, const lattice::SpringConstants& central,
              const lattice::SpringConstants& hookean, double spacing) {
  Job job;
  job.kind = "cubes";
  job.inputs = {{"rubber", rubber_inputs(rubber, lattice::Kinematics::small)},
                {"central", json_of(central)},
                {"hookean", json_of(hookean)},
                {"spacing", spacing}};
  job.source_hash = source_hash::calibration;
  job.weight = 1.0;
  job.run = [=](const fs::path& folder, const JobContext& context) {
    run_cubes(rubber, central, hookean, spacing, folder, context);
  };
  return job;
}

}  // namespace fingertip::studies
