#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "meshes/press_response.h"
#include "studies/cli/verbs.h"
#include "studies/report/report.h"

namespace fingertip::studies {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& place, const std::string& rule,
                         const std::string& remedy) {
  throw ConfigError({{place, "", "", rule, remedy}});
}

/// A folder with a response.csv; a validate folder stands for the runs inside it, continuum first.
std::vector<fs::path> expand(const std::string& run) {
  const fs::path folder = run;
  if (!fs::is_directory(folder)) {
    refuse("RUN " + run, "there is no such folder", "give the folder of a run");
  }
  if (fs::exists(folder / "response.csv")) return {folder};
  std::vector<fs::path> inside;
  for (const char* name : {"reference", "published", "central", "hookean"}) {
    if (fs::exists(folder / name / "response.csv")) inside.push_back(folder / name);
  }
  if (inside.empty()) {
    refuse("RUN " + run, "holds no response.csv",
           "give the folder of a press, reference or "
           "validate run");
  }
  return inside;
}

std::string label(const fs::path& run) {
  return fs::absolute(run / "").lexically_normal().parent_path().filename().string();
}

/// Pointwise and relative L2 differences from the first curve.
void print_comparison(const std::vector<fs::path>& runs) {
  std::vector<meshes::PressResponse> curves;
  for (const fs::path& run : runs) {
    curves.push_back(meshes::PressResponse::read_csv(run / "response.csv"));
  }
  const meshes::PressResponse& first = curves.front();
  fmt::print("{:>12}{:>24}", "depth [cm]", label(runs.front()).substr(0, 16) + " [gf]");
  for (std::size_t i = 1; i < runs.size(); ++i) fmt::print("{:>22}", label(runs[i]).substr(0, 21));
  fmt::print("\n");
  for (const double depth : meshes::default_samples(first.depth())) {
    fmt::print("{:12.4f}{:24.4f}", 100.0 * depth, first.normal_force_at(depth) / 9.80665e-3);
    for (std::size_t i = 1; i < curves.size(); ++i) {
      const bool reached = depth <= curves[i].depth();
      fmt::print("{:>22}", reached ? fmt::format("{:+.2f} %", 100.0 * relative_force_error(
                                                                          curves[i], first, depth))
                                   : "");
    }
    fmt::print("\n");
  }
  fmt::print("{:>36}", "relative L2 difference");
  for (std::size_t i = 1; i < curves.size(); ++i) {
    const double to = std::min(first.depth(), curves[i].depth());
    fmt::print("{:>22}",
               fmt::format("{:.2f} %", 100.0 * relative_l2_force_error(curves[i], first, 0.0, to)));
  }
  fmt::print("\n");
}

}  // namespace

int run_compare(const CommandLine& line) {
  std::vector<fs::path> runs;
  for (const std::string& argument : line.arguments) {
    for (const fs::path& run : expand(argument)) runs.push_back(run);
  }
  if (runs.size() < 2) {
    refuse("compare", "at least two runs are needed", "give two run folders, or one of validate");
  }
  // The continuum is what the others are measured against, wherever it was named.
  std::ranges::stable_partition(runs,
                                [](const fs::path& run) { return fs::exists(run / "job.json"); });
  const fs::path out = line.out.empty() ? fs::path("runs/comparison") : line.out;
  if (!line.out.empty() && fs::exists(out) && !line.force) {
    refuse("--out " + out.string(), "the output folder exists already",
           "choose another folder, or say --force to write into it");
  }
  write_comparison(runs, out);
  if (!line.quiet) {
    print_comparison(runs);
    fmt::print("comparison: {}\n", (out / "comparison.html").string());
  }
  return 0;
}

int run_report(const CommandLine& line) {
  if (line.arguments.empty()) {
    refuse("report", "no run folder is given", "give the folder of a validate or calibrate run");
  }
  for (const std::string& run : line.arguments) {
    write_report(run);
    if (!line.quiet) fmt::print("report: {}\n", (fs::path(run) / "report.html").string());
  }
  return 0;
}

}  // namespace fingertip::studies
