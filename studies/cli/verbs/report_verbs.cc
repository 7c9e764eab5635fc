#include <fmt/format.h>

#include <cstdio>

#include "meshes/base/errors.h"
#include "studies/cli/verbs/verbs.h"
#include "studies/config/asked_units.h"
#include "studies/config/value_reader.h"
#include "studies/jobs/fresh_folder.h"
#include "studies/report/report.h"

namespace fingertip::studies::inline cli::inline verbs {

namespace {

namespace fs = std::filesystem;

/// The units that --set asks for.
std::optional<UnitSystem> wanted_units(const CommandLine& line) {
  const LoadedConfig loaded = load_config({{}, line.config.sets, {}});
  for (const auto& [key, entry] : loaded.entries) {
    if (entry.given && key != "run.units")
      throw ConfigError({key, unquoted(entry.literal),
                         "a page of finished runs takes run.units alone",
                         "give the key to the verb that makes the run", entry.place});
  }
  return loaded.entries.at("run.units").given ? std::optional(asked_units(loaded)) : std::nullopt;
}

void throw_damage(const report::Damages& damage) {
  if (!damage.empty()) throw meshes::InvalidInput(damage);
}

void require_folder(const std::string& run) {
  if (!fs::is_directory(run))
    refuse("RUN " + run, "there is no such folder", "give the folder of a run");
}

}  // namespace

int run_compare(const CommandLine& line) {
  const std::optional<UnitSystem> wanted = wanted_units(line);
  std::vector<fs::path> runs;
  for (const std::string& run : line.arguments) {
    require_folder(run);
    runs.emplace_back(run);
  }
  if (!line.out.empty() && fs::exists(line.out) && !line.force) {
    refuse("--out " + line.out.string(), "the output folder exists already",
           "choose another folder, or say --force to write into it");
  }
  const ShowIn units(wanted.value_or(UnitSystem::si));
  const bool own_folder = line.out.empty();
  const fs::path out = own_folder ? make_run_folder("comparison") : line.out;
  const report::ComparisonResult result = [&] {
    try {
      return report::write_comparison(runs, out);
    } catch (...) {
      std::error_code not_empty;
      if (own_folder) fs::remove(out, not_empty);  // what was refused leaves nothing
      throw;
    }
  }();
  if (!line.quiet) {
    fmt::print("{}comparison: {}\n", result.text, (out / "comparison.html").string());
    std::fflush(stdout);
  }
  throw_damage(result.damage);
  return 0;
}

int run_report(const CommandLine& line) {
  if (line.arguments.empty()) {
    refuse("report", "no run folder is given", "give the folder of a run");
  }
  const std::optional<UnitSystem> units = wanted_units(line);
  report::Damages damage;
  for (const std::string& run : line.arguments) {
    require_folder(run);
    const report::Damages found = report::write_report(run, units);
    damage.insert(damage.end(), found.begin(), found.end());
    if (line.quiet) continue;
    fmt::print("report: {}{}\n", (fs::path(run) / "report.html").string(),
               found.empty() ? "" : " (without what is damaged)");
    std::fflush(stdout);
  }
  throw_damage(damage);
  return 0;
}

int run_limit_surface(const CommandLine& line) {
  if (line.arguments.empty())
    refuse("limit-surface", "no run folder is given", "give the folder of a press or a reference");
  const ShowIn units(wanted_units(line).value_or(UnitSystem::si));
  for (const std::string& run : line.arguments) {
    require_folder(run);
    const std::string text = report::write_limit_surface(run);
    if (line.quiet) continue;
    fmt::print("{}written: {}\n", text, (fs::path(run) / "limit_surface.csv").string());
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace fingertip::studies::inline cli::inline verbs
