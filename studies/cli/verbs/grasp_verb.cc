#include <fmt/format.h>

#include <cmath>

#include "studies/cli/command_line/run_verb.h"
#include "studies/cli/verbs/verbs.h"
#include "studies/files/grasp_summary.h"
#include "studies/files/read_fields.h"
#include "studies/files/shown_units.h"
#include "studies/presses/grasp_job.h"
#include "studies/presses/press_setup.h"

namespace fingertip::studies::inline cli::inline verbs {

namespace {

void print_row(const char* what, const std::string& value) {
  fmt::print("{:<44}{}\n", what, value);
}

void print_grasp(const lattice::GraspSetup& setup, const GraspSummary& summary) {
  const ShownUnit& force = shown_units().force;
  const lattice::FingerSetup& finger = setup.hand.finger;
  fmt::print("two {} fingers, {} contact: the block was {}\n", lattice::name(finger.lattice.model),
             meshes::name(finger.contact.mode), summary.fate);
  print_row("grip force per finger, wanted", force.text(summary.wanted_force));
  if (finger.contact.mode == meshes::ContactMode::coulomb) {
    print_row("least one by m g/(2 mu)", force.text(summary.least_force_at_rest));
    print_row("with the lift's acceleration", force.text(summary.least_force));
  }
  if (!std::isnan(summary.slip_force)) {
    print_row("every point slides from", force.text(summary.slip_force));
    print_row("tangential over normal force there", fmt::format("{:.4g}", summary.slip_ratio));
  }
  if (std::isnan(summary.held_load)) return;
  print_row("weight carried by the fingers", fmt::format("{:.2f} %", 100.0 * summary.held_load));
  print_row("tangential over normal force", fmt::format("{:.4g}", summary.held_ratio));
  print_row("slip at the end of the hold", shown_units().length.text(summary.held_slip));
}

}  // namespace

int run_grasp(const CommandLine& line) {
  const LoadedConfig loaded = with_material(at_pace(load_checked(line)), LatticeUse::modes);
  const lattice::GraspSetup setup = grasp_setup(loaded);
  return run_in_folder(line, loaded, {}, [&](Session& session) {
    const JobResult result = session.run({"", grasp_job(setup), false});
    if (line.quiet) return 0;
    const auto file = session.folder().path() / "summary.json";
    print_grasp(setup, struct_of<GraspSummary>(read_entry(file)));
    print_folder(session, result);
    return 0;
  });
}

}  // namespace fingertip::studies::inline cli::inline verbs
