#include "studies/fits/runs/moduli_job.h"

#include <functional>

#include "calibration/moduli/cube_test.h"
#include "calibration/moduli/result_io.h"
#include "lattice/press/setup_fields.h"
#include "meshes/press/fields.h"
#include "meshes/tables/fields_json.h"
#include "meshes/tables/table_rows.h"
#include "source_hash.h"
#include "studies/files/run_tables.h"
#include "studies/jobs/provenance.h"
#include "studies/presses/press_record.h"

namespace fingertip::studies::inline fits::inline runs {

namespace {

using lattice::ModelKind;
using meshes::json_of;
namespace fs = std::filesystem;

void run_moduli(const meshes::Rubber& rubber, const calibration::ModuliFitOptions& options,
                const fs::path& folder, const JobContext& context) {
  context.report(0.0, "constants");
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

}  // namespace

Job moduli_job(const meshes::Rubber& rubber, const calibration::ModuliFitOptions& options) {
  return {.kind = "moduli",
          .inputs = {{"rubber", rubber_inputs(rubber, lattice::Kinematics::small)},
                     {"model", lattice::name(options.model)},
                     {"spacing", options.spacing},
                     {"isotropy_weight", options.isotropy_weight},
                     {"bulk_weight", options.bulk_weight}},
          .source_hash = source_hash::calibration,
          .run = std::bind_front(run_moduli, rubber, options),
          .weight = moduli_weight};
}

Job cubes_job(const meshes::Rubber& rubber, const lattice::SpringConstants& central,
              const lattice::SpringConstants& hookean, double spacing) {
  return {.kind = "cubes",
          .inputs = {{"rubber", rubber_inputs(rubber, lattice::Kinematics::small)},
                     {"central", json_of(central)},
                     {"hookean", json_of(hookean)},
                     {"spacing", spacing}},
          .source_hash = source_hash::calibration,
          .run = std::bind_front(run_cubes, rubber, central, hookean, spacing)};
}

}  // namespace fingertip::studies::inline fits::inline runs
