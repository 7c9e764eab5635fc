#include "studies/jobs/provenance.h"

#include <ceres/version.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <openssl/crypto.h>
#include <spdlog/version.h>
#include <sys/utsname.h>
#include <toml++/toml.h>
#include <unistd.h>
#include <CLI/Version.hpp>
#include <Eigen/Core>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "meshes/base/blas.h"
#include "studies/files/places.h"

namespace fingertip::studies::inline jobs {

namespace {

/// The text behind the first line `label<separator>text` of a system file.
std::string field(const char* file, const std::string& label, char separator) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const auto at = line.find(separator);
    if (!line.starts_with(label) || at == line.npos) continue;
    const auto first = line.find_first_not_of(" \t\"", at + 1);
    const auto last = line.find_last_not_of(" \t\"");
    return first == line.npos ? "" : line.substr(first, last - first + 1);
  }
  return "unknown";
}

std::string blas_in_words() {
  const meshes::BlasKernels kernels = meshes::blas_kernels();
  if (kernels.name.empty()) return "not OpenBLAS";
  return "OpenBLAS with kernels for " + kernels.name +
         (kernels.by_features ? " (it does not know this processor, which can run them)" : "");
}

}  // namespace

std::string program_version() {
  return FINGERTIP_VERSION;
}

nlohmann::ordered_json package_versions() {
  nlohmann::ordered_json versions = {
      {"Eigen",
       fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"Ceres", CERES_VERSION_STRING},
      {"CLI11", CLI11_VERSION},
      {"toml++", fmt::format("{}.{}.{}", TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH)},
      {"nlohmann-json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR,
                                    NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)},
      {"spdlog", fmt::format("{}.{}.{}", SPDLOG_VER_MAJOR, SPDLOG_VER_MINOR, SPDLOG_VER_PATCH)},
      {"fmt",
       fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
      {"OpenSSL", OpenSSL_version(OPENSSL_VERSION_STRING)},
      {"compiler", fmt::format("{} {}", FINGERTIP_COMPILER, __VERSION__)}};
  // Of the other program, where it is built.
  if (std::ifstream continuum(passed_on("continuum.json")); continuum)
    versions.update(nlohmann::ordered_json::parse(continuum));
  return versions;
}

double memory_of_machine() {
  return double(::sysconf(_SC_PHYS_PAGES)) * double(::sysconf(_SC_PAGESIZE));
}

nlohmann::ordered_json host_description() {
  utsname system{};
  ::uname(&system);
  return {{"cpu", field("/proc/cpuinfo", "model name", ':')},
          {"cores", std::thread::hardware_concurrency()},
          {"blas", blas_in_words()},
          {"memory [B]", std::uint64_t(memory_of_machine())},
          {"os", field("/etc/os-release", "PRETTY_NAME", '=')},
          {"kernel", system.release}};
}

std::string utc_now() {
  return fmt::format(
      "{:%Y-%m-%dT%H:%M:%SZ}",
      fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
}

}  // namespace fingertip::studies::inline jobs
