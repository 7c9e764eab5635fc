#include "studies/presses/static_press_job.h"

#include "lattice/press/setup_fields.h"
#include "lattice/press/static_press.h"
#include "meshes/tables/fields_json.h"
#include "meshes/tables/table_rows.h"
#include "source_hash.h"
#include "studies/files/run_tables.h"
#include "studies/presses/journal.h"
#include "studies/presses/pictures/snapshot_files.h"
#include "studies/presses/program_summary.h"

namespace fingertip::studies::inline presses {

namespace {

namespace fs = std::filesystem;

PressSummary summary_of(const lattice::PressSetup& setup, const lattice::StaticOutcome& outcome,
                        const std::string& status) {
  PressSummary summary = press_summary_head(setup, status);
  summary.static_census = {long(outcome.sectors), long(outcome.particles), long(outcome.springs),
                           long(outcome.cells),   long(outcome.unknowns),  outcome.volume,
                           outcome.exact_volume};
  summary.effort = {outcome.steps, outcome.newton_iterations, outcome.factorisations};
  summary.program = stage_entries(setup.protocol, outcome.response);
  summary.smallest_jacobian = outcome.smallest_jacobian;
  summary.wall_time = outcome.wall_time;
  return summary;
}

void write_contact(const lattice::StaticOutcome& outcome, const fs::path& folder) {
  std::vector<ContactRow> rows;
  for (const lattice::StaticContactPoint& point : outcome.contact)
    rows.push_back({point.rest, point.deformed, point.pressure});
  meshes::write_rows(rows, folder / "contact.csv");
}

void run_static_job(const lattice::PressSetup& setup, const fs::path& folder,
                    const JobContext& context) {
  Journal<lattice::StaticOutcome> journal(
      folder, context, "pressing",
      [&](const lattice::StaticOutcome& outcome, const std::string& status) {
        outcome.response.write_csv(folder / "response.csv");
        meshes::write_json_file(summary_of(setup, outcome, status), folder / "summary.json");
      },
      std::chrono::milliseconds::zero());
  const lattice::StaticOutcome outcome = journal.run([&](const lattice::StaticObserver& observe) {
    return lattice::run_static_press(setup, observe, true);
  });
  write_contact(outcome, folder);
  write_shapes(outcome, folder);
}

}  // namespace

Job static_press_job(const lattice::PressSetup& setup) {
  Job job;
  job.kind = "press";
  job.inputs = inputs_of(setup);
  job.source_hash = source_hash::lattice;
  job.weight = press_weight(setup);
  job.run = [setup](const fs::path& folder, const JobContext& context) {
    run_static_job(setup, folder, context);
  };
  return job;
}

}  // namespace fingertip::studies::inline presses
