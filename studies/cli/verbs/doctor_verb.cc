#include <fmt/format.h>

#include <unistd.h>
#include <cstdlib>

#include "studies/cases/case_file.h"
#include "studies/cli/verbs/verbs.h"
#include "studies/files/places.h"
#include "studies/files/process.h"
#include "studies/jobs/provenance.h"

namespace fingertip::studies::inline cli::inline verbs {

namespace {

namespace fs = std::filesystem;

/// The folder itself or the nearest one above it that exists.
fs::path existing_part(fs::path folder) {
  folder = fs::absolute(folder);
  while (!fs::exists(folder) && folder.has_relative_path()) folder = folder.parent_path();
  return folder;
}

std::string writability(const fs::path& folder) {
  return ::access(existing_part(folder).c_str(), W_OK) == 0 ? "writable" : "NOT WRITABLE";
}

}  // namespace

int run_doctor(const CommandLine&) {
  const auto row = [](const std::string& name, const std::string& value) {
    fmt::print("{:<16}{}\n", name, value);
  };
  row("fingertip", program_version() + " in " + executable_folder().string());
  const bool built = ::access(reference_program().c_str(), X_OK) == 0,
             continuum = built || std::getenv("FINGERTIP_LAUNCHER") != nullptr;
  row("fingertip-fem", built       ? reference_program().string()
                       : continuum ? "not built: ./fingertip does it when it is first asked for"
                                   : "MISSING: reference and validate cannot run");
  row("mpirun", program_on_path("mpirun").empty()
                    ? "MISSING: reference --ranks N cannot run (package openmpi-bin)"
                    : "found");
  const bool plots = !program_on_path("gnuplot").empty();
  row("gnuplot", plots ? "found" : "MISSING: reports cannot be drawn (package gnuplot-nox)");
  const nlohmann::ordered_json packages = package_versions();
  for (const auto& [name, version] : packages.items()) {
    row(name, version.get<std::string>());
  }
  const nlohmann::ordered_json host = host_description();
  for (const auto& [name, value] : host.items()) {
    row(name, value.is_string() ? value.get<std::string>() : value.dump());
  }
  row("cases", fmt::format("{} in {}", all_cases().size(), cases_folder().string()));
  row("cache", cache_folder().string() + ", " + writability(cache_folder()));
  row("runs", (fs::current_path() / "runs").string() + ", " + writability("runs"));
  return continuum && plots ? 0 : 2;
}

}  // namespace fingertip::studies::inline cli::inline verbs
