#include "studies/run/static_press_job.h"

#include <cmath>
#include <ostream>

#include "lattice/press/setup_fields.h"
#include "lattice/press/static_press.h"
#include "meshes/fields_json.h"
#include "meshes/files.h"
#include "source_hash.h"
#include "studies/run/jobs.h"
#include "studies/run/json_file.h"

namespace fingertip::studies {

namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

ordered_json summary_of(const lattice::PressSetup& setup, const lattice::StaticOutcome& outcome,
                        const std::string& status) {
  ordered_json summary = press_summary_head(setup, status);
  summary["census"] = {{"sectors", outcome.sectors},          {"particles", outcome.particles},
                       {"springs", outcome.springs},          {"cells", outcome.cells},
                       {"unknowns", outcome.unknowns},        {"volume", outcome.volume},
                       {"exact_volume", outcome.exact_volume}};
  summary["effort"] = {{"steps", outcome.steps},
                       {"newton_iterations", outcome.newton_iterations},
                       {"factorisations", outcome.factorisations}};
  summary["smallest_jacobian"] = outcome.smallest_jacobian;
  summary["wall_time"] = outcome.wall_time;
  return summary;
}

void write_contact(const lattice::StaticOutcome& outcome, const fs::path& folder) {
  meshes::write_atomically(folder / "contact.csv", [&](std::ostream& out) {
    out << "x [m],y [m],z [m],deformed_x [m],deformed_y [m],deformed_z [m],pressure [Pa]\n";
    for (const lattice::StaticContactPoint& point : outcome.contact) {
      for (const meshes::Vector3& place : {point.rest, point.deformed})
        for (int axis = 0; axis < 3; ++axis) out << meshes::to_text(place[axis]) << ',';
      out << meshes::to_text(point.pressure) << '\n';
    }
  });
}

void run_static_job(const lattice::PressSetup& setup, const fs::path& folder,
                    const JobContext& context) {
  const auto write = [&](const lattice::StaticOutcome& outcome, const std::string& status) {
    outcome.response.write_csv(folder / "response.csv");
    write_json(summary_of(setup, outcome, status), folder / "summary.json");
  };
  try {
    const lattice::StaticOutcome outcome =
        lattice::run_static_press(setup, [&](const lattice::StaticOutcome& so_far, double done) {
          const bool go_on = context.report(done, "pressing");
          write(so_far, go_on ? "running" : "interrupted");
          return go_on;
        });
    write(outcome, "finished");
    write_contact(outcome, folder);
  } catch (const meshes::NotConverged& error) {
    set_press_status(folder, std::string("not converged: ") + error.what());
    throw;
  } catch (const meshes::Interrupted&) {
    set_press_status(folder, "interrupted");
    throw;
  }
}

}  // namespace

ordered_json press_summary_head(const lattice::PressSetup& setup, const std::string& status) {
  return {{"model", lattice::name(setup.lattice.model)},
          {"kinematics", lattice::name(setup.lattice.kinematics)},
          {"mode", meshes::name(setup.protocol.mode)},
          {"contact", meshes::name(setup.protocol.contact)},
          {"status", status},
          {"spacing", setup.lattice.spacing},
          {"constants", meshes::json_of(setup.lattice.constants)}};
}

void set_press_status(const fs::path& folder, const std::string& status) {
  if (!fs::exists(folder / "summary.json")) return;
  ordered_json summary = read_json(folder / "summary.json");
  summary["status"] = status;
  write_json(summary, folder / "summary.json");
}

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

}  // namespace fingertip::studies
