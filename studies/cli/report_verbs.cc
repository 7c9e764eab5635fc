#include <fmt/format.h>

#include <cstdio>

#include "meshes/errors.h"
#include "studies/cli/verbs.h"
#include "studies/report/report.h"
#include "studies/run/fresh_folder.h"

namespace fingertip::studies {

namespace {

namespace fs = std::filesystem;

void throw_damage(const Damages& damage) {
  if (!damage.empty()) throw meshes::InvalidInput(damage);
}

}  // namespace

int run_compare(const CommandLine& line) {
  std::vector<fs::path> runs;
  for (const std::string& run : line.arguments) {
    if (!fs::is_directory(run)) refuse("RUN " + run, "there is no such folder", "give a run's");
    runs.emplace_back(run);
  }
  if (!line.out.empty() && fs::exists(line.out) && !line.force) {
    refuse("--out " + line.out.string(), "the output folder exists already",
           "choose another folder, or say --force to write into it");
  }
  const fs::path out = line.out.empty() ? make_run_folder("comparison") : line.out;
  const ComparisonResult result = write_comparison(runs, out);
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
  Damages damage;
  for (const std::string& run : line.arguments) {
    if (!fs::is_directory(run)) refuse("RUN " + run, "there is no such folder", "give a run's");
    const Damages found = write_report(run);
    damage.insert(damage.end(), found.begin(), found.end());
    if (line.quiet) continue;
    fmt::print("report: {}{}\n", (fs::path(run) / "report.html").string(),
               found.empty() ? "" : " (without what is damaged)");
    std::fflush(stdout);
  }
  throw_damage(damage);
  return 0;
}

}  // namespace fingertip::studies
