#include <fmt/format.h>

#include <cmath>

#include "studies/cli/command_line/run_verb.h"
#include "studies/cli/verbs/verbs.h"
#include "studies/files/shown_units.h"
#include "studies/jobs/json_file.h"
#include "studies/presses/grasp_job.h"
#include "studies/presses/press_setup.h"

namespace fingertip::studies::inline cli::inline verbs {

namespace {

std::string force_text(const nlohmann::ordered_json& force) {
  return force.is_number() ? shown_units().force.text(force.get<double>()) : "-";
}

void print_row(const char* what, const std::string& value) {
  fmt::print("{:<44}{}\n", what, value);
}

void print_grasp(const lattice::GraspSetup& setup, const std::filesystem::path& folder) {
  const auto summary = read_json(folder / "summary.json");
  const lattice::FingerSetup& finger = setup.hand.finger;
  fmt::print("two {} fingers, {} contact: the block was {}\n", lattice::name(finger.lattice.model),
             meshes::name(finger.contact.mode), summary["fate"].get<std::string>());
  print_row("grip force per finger, wanted", force_text(summary["wanted_force"]));
  if (finger.contact.mode == meshes::ContactMode::coulomb) {
    print_row("least one by m g/(2 mu)", force_text(summary["least_force_at_rest"]));
    print_row("with the lift's acceleration", force_text(summary["least_force"]));
  }
  if (summary["slip_force"].is_number()) {
    print_row("every point slides from", force_text(summary["slip_force"]));
    print_row("tangential over normal force there",
              fmt::format("{:.4g}", summary["slip_ratio"].get<double>()));
  }
  if (!summary["held_load"].is_number()) return;
  print_row("weight carried by the fingers",
            fmt::format("{:.2f} %", 100.0 * summary["held_load"].get<double>()));
  print_row("tangential over normal force",
            fmt::format("{:.4g}", summary["held_ratio"].get<double>()));
  print_row("slip at the end of the hold",
            shown_units().length.text(summary["held_slip"].get<double>()));
}

}  // namespace

int run_grasp(const CommandLine& line) {
  const LoadedConfig loaded = with_material(load_checked(line), LatticeUse::modes);
  const lattice::GraspSetup setup = grasp_setup(loaded);
  return run_in_folder(line, loaded, {}, [&](Session& session) {
    const JobResult result = session.run({"", grasp_job(setup), false});
    if (line.quiet) return 0;
    print_grasp(setup, session.folder().path());
    if (result.reused) {
      fmt::print("(result from an earlier run with the same input)\n");
    } else {
      fmt::print("computed in {:.2f} s\n", result.wall_time);
    }
    fmt::print("run folder: {}\n", session.path_of({}).string());
    return 0;
  });
}

}  // namespace fingertip::studies::inline cli::inline verbs
