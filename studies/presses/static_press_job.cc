#include "studies/presses/static_press_job.h"

#include <cmath>

#include "lattice/press/setup_fields.h"
#include "lattice/press/static_press.h"
#include "meshes/tables/fields_json.h"
#include "meshes/tables/table_rows.h"
#include "source_hash.h"
#include "studies/files/run_tables.h"
#include "studies/presses/pictures/snapshot_files.h"
#include "studies/presses/press_record.h"
#include "studies/presses/program_summary.h"

namespace fingertip::studies::inline presses {

namespace {

using nlohmann::ordered_json;
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
  const auto write = [&](const lattice::StaticOutcome& outcome, const std::string& status) {
    outcome.response.write_csv(folder / "response.csv");
    meshes::write_json_file(summary_of(setup, outcome, status), folder / "summary.json");
  };
  const auto observe = [&](const lattice::StaticOutcome& so_far, double done) {
    const bool go_on = context.report(done, "pressing");
    write(so_far, go_on ? "running" : "interrupted");
    return go_on;
  };
  try {
    const lattice::StaticOutcome outcome = lattice::run_static_press(setup, observe, true);
    write(outcome, "finished");
    write_contact(outcome, folder);
    write_shapes(outcome, folder);
  } catch (const meshes::NotConverged& error) {
    set_press_status(folder, std::string("not converged: ") + error.what());
    throw;
  } catch (const meshes::Interrupted&) {
    set_press_status(folder, "interrupted");
    throw;
  }
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
