#include <fmt/format.h>

#include <map>

#include "studies/cli/command_line/run_verb.h"
#include "studies/cli/verbs/fit_screen.h"
#include "studies/cli/verbs/verbs.h"
#include "studies/files/json_entry.h"
#include "studies/files/plan_file.h"
#include "studies/files/read_fields.h"
#include "studies/files/shown_units.h"
#include "studies/fits/runs/plan_job.h"
#include "studies/fits/setup/configured_fit.h"
#include "studies/report/chapters/fit/calibration_chapters.h"
#include "studies/report/page/terminal.h"

namespace fingertip::studies::inline cli::inline verbs {

std::pair<double, std::string> as_shown(double value, const std::string& si) {
  const ShownUnit* unit = shown_units().of(si);
  return unit == nullptr ? std::pair(value, si)
                         : std::pair((*unit)(value), std::string(unit->ascii));
}

namespace {

void print_plan(const PlanFile& plan) {
  fmt::print("{}\n\n", in_shown_units(plan.statement, Spelling::terminal));
  for (const PlannedPress& press : plan.presses)
    fmt::print("{}: {}, {} values to {}, {}\n", press.name,
               in_shown_units(press.condition, Spelling::terminal), press.points,
               shown_units().length.text(press.depth),
               shown_units().force.text(press.largest_force));
  report::Table table{report::heads({"Parameter", "Value", "95 % from", "to", "Unit"})};
  std::map<std::string, std::string> units;
  for (const PlannedParameter& parameter : plan.parameters) {
    const auto shown = [&](double value) {
      return report::number(as_shown(value, parameter.unit).first);
    };
    const auto [value, unit] = as_shown(parameter.value, parameter.unit);
    table.rows.push_back({parameter.name, report::number(value), shown(parameter.lower),
                          shown(parameter.upper), unit});
    units[parameter.name] = parameter.unit;
  }
  fmt::print("\n{}", report::table_text(table));
  if (!plan.next.empty())
    fmt::print("\nA further measurement would make the intervals so many times narrower:\n{}",
               report::table_text(report::next_table(plan.next, units)));
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
    print_plan(struct_of<PlanFile>(read_entry(file)));
    if (result.reused) fmt::print("(result from an earlier run with the same input)\n");
    fmt::print("run folder: {}\n", session.folder().path().string());
    return 0;
  });
}

}  // namespace fingertip::studies::inline cli::inline verbs
