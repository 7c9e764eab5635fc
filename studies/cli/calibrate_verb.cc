#include <fmt/format.h>

#include <cmath>

#include "studies/cli/run_verb.h"
#include "studies/cli/verbs.h"
#include "studies/config/units.h"
#include "studies/run/fit_plan.h"
#include "studies/run/json_file.h"

namespace fingertip::studies {

namespace {

using nlohmann::ordered_json;

/// Stage by stage; a job that is alone gets all threads. Whether anything was computed.
bool run_stages(FitPlan& plan, Session& session) {
  bool computed = false;
  const std::filesystem::path& folder = session.folder().path();
  for (auto jobs = plan.next(folder); !jobs.empty(); jobs = plan.next(folder)) {
    const auto results =
        jobs.size() == 1 ? std::vector{session.run(jobs.front())} : session.run_all(jobs);
    for (const JobResult& result : results) computed = computed || !result.reused;
  }
  return computed;
}

void print_moduli(const ordered_json& content) {
  fmt::print("{:<22}{:>14}{:>14}{:>16}\n", "", "target", "achieved", "achieved [Pa]");
  const auto& target = content["target"];
  const auto& achieved = content["achieved"];
  const auto row = [&](const char* name, const char* wanted, const char* reached) {
    const double pascal = achieved[reached].get<double>();
    fmt::print("{:<22}{:>14.4f}{:>14.4f}{:>16.6g}\n", name,
               convert(target[wanted].get<double>(), "Pa", "gf/cm^2"),
               convert(pascal, "Pa", "gf/cm^2"), pascal);
  };
  row("E_100 [gf/cm^2]", "youngs_modulus", "youngs_modulus_100");
  row("E_110 [gf/cm^2]", "youngs_modulus", "youngs_modulus_110");
  row("E_111 [gf/cm^2]", "youngs_modulus", "youngs_modulus_111");
  row("G [gf/cm^2]", "shear_modulus", "shear_modulus");
  row("K [gf/cm^2]", "bulk_modulus", "bulk_modulus");
  fmt::print("{:<22}{:>14.6f}{:>14.6f}\n", "nu_100", target["poissons_ratio"].get<double>(),
             achieved["poissons_ratio_100"].get<double>());
  fmt::print("{:<22}{:>14.6f}{:>14.6f}\n", "anisotropy A", 1.0,
             achieved["anisotropy"].get<double>());
}

/// SI beside the units of the paper.
void print_parameters(const ordered_json& content) {
  fmt::print("{:<24}{:>14}{:>14}{:>14}  {:<8}{:>16}\n", "", "estimate", "95 % from", "to", "unit",
             "[gf, cm]");
  for (const ordered_json& one : content["parameters"]) {
    const std::string unit = one["unit"];
    const double value = number_of(one["estimate"]);
    const std::string other =
        unit == "Pa"    ? fmt::format("{:.5g} gf/cm^2", convert(value, "Pa", "gf/cm^2"))
        : unit == "N/m" ? fmt::format("{:.5g} gf/cm", convert(value, "N/m", "gf/cm"))
                        : "";
    fmt::print("{:<24}{:>14.6g}{:>14.6g}{:>14.6g}  {:<8}{:>16}\n", one["name"].get<std::string>(),
               value, number_of(one["lower"]), number_of(one["upper"]), unit, other);
  }
}

}  // namespace

int run_calibrate(const CommandLine& line) {
  const LoadedConfig loaded = load_checked(line);
  FitPlan plan(loaded, "");
  if (!line.quiet)
    for (const std::string& note : plan.notes()) fmt::print(stderr, "fingertip: note: {}\n", note);
  return run_in_folder(line, loaded, {}, [&](Session& session) {
    for (const std::string& note : plan.notes()) session.folder().log(note);
    const bool computed = run_stages(plan, session);
    if (line.quiet) return 0;
    const ordered_json content = read_json(session.folder().path() / "calibration.json");
    fmt::print("{}\n\n", content["statement"].get<std::string>());
    if (content.contains("parameters")) {
      print_parameters(content);
    } else {
      print_moduli(content);
    }
    if (!computed) fmt::print("(result from an earlier run with the same input)\n");
    fmt::print("run folder: {}\n", session.folder().path().string());
    return 0;
  });
}

}  // namespace fingertip::studies
