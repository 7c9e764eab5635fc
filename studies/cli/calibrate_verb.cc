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
  fmt::print("{:<22}{:>14}{:>14}{:>22}\n", "", "target", "achieved", "achieved [gf/cm^2]");
  const auto& target = content["target"];
  const auto& achieved = content["achieved"];
  const auto row = [&](const char* name, const char* wanted, const char* reached) {
    const double pascal = achieved[reached].get<double>();
    fmt::print("{:<22}{:>14.6g}{:>14.6g}{:>22.6g}\n", name, 1e-3 * target[wanted].get<double>(),
               1e-3 * pascal, convert(pascal, "Pa", "gf/cm^2"));
  };
  row("E_100 [kPa]", "youngs_modulus", "youngs_modulus_100");
  row("E_110 [kPa]", "youngs_modulus", "youngs_modulus_110");
  row("E_111 [kPa]", "youngs_modulus", "youngs_modulus_111");
  row("G [kPa]", "shear_modulus", "shear_modulus");
  row("K [kPa]", "bulk_modulus", "bulk_modulus");
  fmt::print("{:<22}{:>14.6f}{:>14.6f}\n", "nu_100", target["poissons_ratio"].get<double>(),
             achieved["poissons_ratio_100"].get<double>());
  fmt::print("{:<22}{:>14.6f}{:>14.6f}\n", "anisotropy A", 1.0,
             achieved["anisotropy"].get<double>());
}

/// SI beside the units of the paper.
void print_parameters(const ordered_json& content) {
  fmt::print("{:<24}{:>14}{:>14}{:>14}  {:<8}{:>16}\n", "", "estimate", "95 % from", "to", "unit",
             "[gf, cm]");
  const bool ratio_bound = !content.value("poissons_ratio_bound", ordered_json()).is_null();
  for (const ordered_json& one : content["parameters"]) {
    const std::string unit = one["unit"];
    const double value = number_of(one["estimate"]);
    const std::string other =
        unit == "Pa"    ? fmt::format("{:.5g} gf/cm^2", convert(value, "Pa", "gf/cm^2"))
        : unit == "N/m" ? fmt::format("{:.5g} gf/cm", convert(value, "N/m", "gf/cm"))
                        : "";
    const double lower = number_of(one["lower"]), upper = number_of(one["upper"]);
    // Where Poisson's ratio has stopped at a bound neither modulus has an interval of its own.
    const bool open = !(upper - lower <= 2.0 * std::abs(value)) ||
                      (ratio_bound && one["name"].get<std::string>() != "modulus");
    const auto end = [&](double number) {
      return open ? std::string("open") : fmt::format("{:.6g}", number);
    };
    fmt::print("{:<24}{:>14.6g}{:>14}{:>14}  {:<8}{:>16}\n", one["name"].get<std::string>(), value,
               end(lower), end(upper), unit, other);
  }
}

/// What a press takes: spring constants, or the network's moduli.
void print_constants(const ordered_json& content) {
  const auto row = [](const char* name, double value, const char* unit, const char* other) {
    fmt::print("{:<24}{:>14.6g} {:<6}{:>14.6g} {}\n", name, value, unit,
               convert(value, unit, other), other);
  };
  const ordered_json& constants = content["constants"];
  const bool network = content["model"] == "network";
  fmt::print("\nconstants of the lattice, {}, spacing {:.6g} mm\n",
             content["model"].get<std::string>(), 1e3 * number_of(content["spacing"]));
  if (network) {
    row("E", number_of(content["achieved"]["youngs_modulus_100"]), "Pa", "gf/cm^2");
    row("G", number_of(constants["G"]), "Pa", "gf/cm^2");
    row("lambda", number_of(constants["lambda"]), "Pa", "gf/cm^2");
    return;
  }
  for (const char* name : {"k1", "k2", "k3"}) row(name, number_of(constants[name]), "N/m", "gf/cm");
  row("kappa", number_of(constants["kappa"]), "Pa", "gf/cm^2");
}

/// The rubber that measured curves tell.
void print_rubber(const ordered_json& content) {
  if (!content.contains("rubber") || content["problem"] == "damping") return;
  const double e = number_of(content["rubber"]["youngs_modulus"]),
               g = number_of(content["rubber"]["shear_modulus"]);
  fmt::print("\nrubber: E {:.6g} kPa, G {:.6g} kPa, lambda {:.6g} kPa, Poisson's ratio {:.4f}\n",
             1e-3 * e, 1e-3 * g, 1e-3 * g * (e - 2.0 * g) / (3.0 * g - e), 0.5 * e / g - 1.0);
}

/// Exit code of a fit that failed its own tests, with what that means on stderr.
int verdict(const ordered_json& content, bool written) {
  const ordered_json failed = content.value("failed", ordered_json::array());
  for (const ordered_json& one : failed)
    fmt::print(stderr, "fingertip: not accepted: {}\n", one.get<std::string>());
  if (!failed.empty())
    fmt::print(stderr, "fingertip: {}\n",
               written ? "material.toml is written as --force asks, and says so"
                       : "no material.toml is written; --force writes it all the same");
  if (!content.value("converged", true)) return 3;
  return failed.empty() ? 0 : 4;
}

}  // namespace

int run_calibrate(const CommandLine& line) {
  const LoadedConfig loaded = load_checked(line);
  FitPlan plan(loaded, "", line.force ? FitPlan::Failed::kept : FitPlan::Failed::refused);
  if (!line.quiet)
    for (const std::string& note : plan.notes()) fmt::print(stderr, "fingertip: note: {}\n", note);
  return run_in_folder(line, loaded, {}, [&](Session& session) {
    for (const std::string& note : plan.notes()) session.folder().log(note);
    const bool computed = run_stages(plan, session);
    const std::filesystem::path& folder = session.folder().path();
    const ordered_json content = read_json(folder / "calibration.json");
    const bool written = std::filesystem::exists(folder / "material.toml");
    if (line.quiet) return verdict(content, written);
    fmt::print("{}\n\n", content["statement"].get<std::string>());
    if (content.contains("parameters")) {
      print_parameters(content);
    } else {
      print_moduli(content);
    }
    print_rubber(content);
    print_constants(content);
    if (!computed) fmt::print("(result from an earlier run with the same input)\n");
    fmt::print("run folder: {}\n", folder.string());
    return verdict(content, written);
  });
}

}  // namespace fingertip::studies
