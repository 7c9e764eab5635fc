#include <fmt/format.h>

#include "studies/cli/command_line/run_verb.h"
#include "studies/cli/verbs/fit_screen.h"
#include "studies/cli/verbs/verbs.h"
#include "studies/files/json_entry.h"
#include "studies/files/shown_units.h"
#include "studies/fits/runs/calibration_stages.h"
#include "studies/report/report.h"

namespace fingertip::studies::inline cli::inline verbs {

namespace {

using nlohmann::ordered_json;

/// Stage by stage; a job that is alone gets all threads. Whether anything was computed.
bool run_stages(CalibrationStages& stages, Session& session) {
  bool computed = false;
  const std::filesystem::path& folder = session.folder().path();
  for (auto jobs = stages.next(folder); !jobs.empty(); jobs = stages.next(folder)) {
    session.expect_later(stages.later_weight());
    const auto results =
        jobs.size() == 1 ? std::vector{session.run(jobs.front())} : session.run_all(jobs);
    for (const JobResult& result : results) computed = computed || !result.reused;
  }
  return computed;
}

/// What a press takes: spring constants, or the network's moduli.
void print_constants(const ordered_json& content) {
  const auto row = [](const char* name, const ordered_json& number, const char* si) {
    const auto [value, unit] = as_shown(number_of(number), si);
    fmt::print("{:<24}{:>14.6g} {}\n", name, value, unit);
  };
  const ordered_json& constants = content["constants"];
  const bool network = content["model"] == "network";
  fmt::print("\nconstants of the lattice, {}, spacing {}\n", content["model"].get<std::string>(),
             shown_units().length.text(number_of(content["spacing"])));
  if (network) {
    row("E", content["achieved"]["youngs_modulus_100"], "Pa");
    row("G", constants["G"], "Pa");
    row("lambda", constants["lambda"], "Pa");
    return;
  }
  for (const char* name : {"k1", "k2", "k3"}) row(name, constants[name], "N/m");
  row("kappa", constants["kappa"], "Pa");
}

/// The rubber that measured curves tell.
void print_rubber(const ordered_json& content) {
  if (!content.contains("rubber") || content["problem"] == "damping") return;
  const double e = number_of(content["rubber"]["youngs_modulus"]),
               g = number_of(content["rubber"]["shear_modulus"]);
  const ShownUnit& stress = shown_units().stress;
  fmt::print("\nrubber: E {:.6g} {u}, G {:.6g} {u}, lambda {:.6g} {u}, Poisson's ratio {:.4f}\n",
             stress(e), stress(g), stress(g * (e - 2.0 * g) / (3.0 * g - e)), 0.5 * e / g - 1.0,
             fmt::arg("u", stress.ascii));
}

/// Displacements alone do not.
bool tells_stiffness(const ordered_json& content) {
  return !content.contains("displacements") || !content["curves"].empty();
}

int verdict_of(const ordered_json& content, bool written) {
  return verdict(content.value("failed", std::vector<std::string>()),
                 content.value("converged", true),
                 tells_stiffness(content) ? std::optional(written) : std::nullopt);
}

}  // namespace

int verdict(const std::vector<std::string>& failed, bool converged, std::optional<bool> written) {
  for (const std::string& reason : failed)
    fmt::print(stderr, "fingertip: not accepted: {}\n", in_shown_units(reason, Spelling::terminal));
  if (!failed.empty() && written)
    fmt::print(stderr, "fingertip: {}\n",
               *written ? "material.toml is written as --force asks, and says so"
                        : "no material.toml is written; --force writes it all the same");
  if (!converged) return 3;
  return failed.empty() ? 0 : 4;
}

int run_calibrate(const CommandLine& line) {
  const LoadedConfig loaded = load_checked(line);
  if (line.plan) return run_plan(line, loaded);
  if (loaded.config.calibration.problem == CalibrationProblem::material)
    return run_material(line, loaded);
  CalibrationStages stages(
      loaded, "",
      line.force ? CalibrationStages::Failed::kept : CalibrationStages::Failed::refused);
  if (!line.quiet)
    for (const std::string& note : stages.notes())
      fmt::print(stderr, "fingertip: note: {}\n", note);
  return run_in_folder(line, loaded, {}, [&](Session& session) {
    for (const std::string& note : stages.notes()) session.folder().log(note);
    const bool computed = run_stages(stages, session);
    const std::filesystem::path& folder = session.folder().path();
    const ordered_json content = parse_json(folder / "calibration.json");
    const bool written = std::filesystem::exists(folder / "material.toml");
    if (line.quiet) return verdict_of(content, written);
    fmt::print("{}\n\n",
               in_shown_units(content["statement"].get<std::string>(), Spelling::terminal));
    fmt::print("{}", report::verdict_text(folder));
    if (tells_stiffness(content)) {
      print_rubber(content);
      print_constants(content);
    }
    if (!computed) fmt::print("(result from an earlier run with the same input)\n");
    fmt::print("run folder: {}\n", folder.string());
    return verdict_of(content, written);
  });
}

}  // namespace fingertip::studies::inline cli::inline verbs
