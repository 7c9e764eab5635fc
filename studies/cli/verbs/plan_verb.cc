#include <fmt/format.h>

#include "studies/cli/command_line/run_verb.h"
#include "studies/cli/verbs/fit_screen.h"
#include "studies/cli/verbs/verbs.h"
#include "studies/files/plan_file.h"
#include "studies/files/read_fields.h"
#include "studies/files/shown_units.h"
#include "studies/fits/runs/plan_job.h"
#include "studies/fits/setup/configured_fit.h"
#include "studies/jobs/json_file.h"

namespace fingertip::studies::inline cli::inline verbs {

std::pair<double, std::string> as_shown(double value, const std::string& si) {
  const ShownUnit* unit = shown_units().of(si);
  return unit == nullptr ? std::pair(value, si)
                         : std::pair((*unit)(value), std::string(unit->ascii));
}

void print_next(const std::vector<calibration::NextEntry>& next) {
  if (next.empty()) return;
  fmt::print("\nA further measurement would make the intervals so many times narrower:\n");
  const auto table = std::ranges::find_if(
      next, [](const calibration::NextEntry& entry) { return !entry.parameters.empty(); });
  if (table != next.end()) {
    fmt::print("{:<12}", "");
    for (const auto& parameter : table->parameters) fmt::print("{:>26.24}", parameter.name);
    fmt::print("\n");
  }
  for (const calibration::NextEntry& entry : next) {
    fmt::print("{:<12}", entry.name);
    for (const auto& parameter : entry.parameters) fmt::print("{:>26.2f}", parameter.times);
    fmt::print("  {}\n",
               in_shown_units(entry.failure.empty() ? entry.press : "not known: " + entry.failure,
                              Spelling::terminal));
  }
}

namespace {

void print_plan(const PlanFile& plan) {
  fmt::print("{}\n\n", in_shown_units(plan.statement, Spelling::terminal));
  for (const PlannedPress& press : plan.presses)
    fmt::print("{}: {}, {} values to {}, {}\n", press.name,
               in_shown_units(press.condition, Spelling::terminal), press.points,
               shown_units().length.text(press.depth),
               shown_units().force.text(press.largest_force));
  fmt::print("\n{:<24}{:>14}{:>14}{:>14}  {}\n", "", "value", "95 % from", "to", "unit");
  for (const PlannedParameter& parameter : plan.parameters) {
    const auto [value, unit] = as_shown(parameter.value, parameter.unit);
    fmt::print("{:<24}{:>14.6g}{:>14.6g}{:>14.6g}  {}\n", parameter.name, value,
               as_shown(parameter.lower, parameter.unit).first,
               as_shown(parameter.upper, parameter.unit).first, unit);
  }
  print_next(plan.next);
}

}  // namespace

int run_plan(const CommandLine& line, const LoadedConfig& loaded) {
  const FitSetup setup = plan_setup(loaded);
  if (!line.quiet)
    for (const std::string& note : setup.notes) fmt::print(stderr, "fingertip: note: {}\n", note);
  const CalibrationSettings& settings = loaded.config.calibration;
  return run_in_folder(line, loaded, {}, [&](Session& session) {
    for (const std::string& note : setup.notes) session.folder().log(note);
    const JobResult result =
        session.run({"", plan_job(setup.input, {settings.noise, settings.noise_force}), false});
    const std::filesystem::path file = session.folder().path() / plan_name;
    if (line.quiet) return 0;
    print_plan(struct_of<PlanFile>(JsonEntry(read_json(file), file)));
    if (result.reused) fmt::print("(result from an earlier run with the same input)\n");
    fmt::print("run folder: {}\n", session.folder().path().string());
    return 0;
  });
}

}  // namespace fingertip::studies::inline cli::inline verbs
