#include "studies/presses/modes_job.h"

#include <cmath>

#include "lattice/press/setup_fields.h"
#include "lattice/press/static_press.h"
#include "lattice/statics/mode_motion.h"
#include "lattice/statics/vibration_modes.h"
#include "meshes/press/fields.h"
#include "meshes/tables/fields_json.h"
#include "meshes/tables/table_rows.h"
#include "source_hash.h"
#include "studies/files/run_tables.h"

namespace fingertip::studies::inline presses {

namespace {

namespace fs = std::filesystem;

void run_modes_job(const lattice::PressSetup& setup, int count, const fs::path& folder,
                   const JobContext& context) {
  // The whole tip, so that modes of every symmetry are found.
  const lattice::LatticeBody body = lattice::static_body(setup, 1);
  const auto modes = lattice::vibration_modes(
      body, count, [&] { return !context.report(0.0, "natural frequencies"); });
  std::vector<LatticeModeRow> rows;
  for (const auto& mode : modes) {
    const lattice::ModeMotion motion = lattice::motion_of(body, mode.shape, setup.lattice.spacing);
    rows.push_back({int(rows.size()) + 1, mode.frequency, lattice::description(motion),
                    motion.effective_mass, motion.effective_inertia, motion.waves});
  }
  meshes::write_rows(rows, folder / "modes.csv");
  meshes::write_json_file({{"model", lattice::name(setup.lattice.model)},
                           {"status", "finished"},
                           {"spacing", setup.lattice.spacing},
                           {"constants", meshes::json_of(setup.lattice.constants)},
                           {"particles", body.rest.size()},
                           {"cells", body.cells.size()}},
                          folder / "summary.json");
}

}  // namespace

Job modes_job(const lattice::PressSetup& setup, int count) {
  Job job;
  job.kind = "modes";
  job.inputs = {{"geometry", meshes::json_of(setup.geometry)},
                {"rubber", meshes::json_of(setup.rubber)},
                {"lattice", meshes::json_of(setup.lattice)},
                {"modes", count}};
  job.inputs["rubber"].erase("retardation_time");  // undamped
  job.inputs["rubber"].erase("relaxation");        // after long times
  job.inputs["rubber"].erase("energy");            // at rest
  job.source_hash = source_hash::lattice;
  job.weight = 2.0 * std::pow(setup.geometry.tip_radius / (12.0 * setup.lattice.spacing), 6);
  job.run = [setup, count](const fs::path& folder, const JobContext& context) {
    run_modes_job(setup, count, folder, context);
  };
  return job;
}

}  // namespace fingertip::studies::inline presses
