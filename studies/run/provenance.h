/// What a result was made with: program, packages, machine.
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

namespace fingertip::studies {

/// The program's version, e.g. "0.1.0".
std::string program_version();

/// Versions of the libraries this program and fingertip-fem (when built) were compiled with.
nlohmann::ordered_json package_versions();

/// {"cpu", "cores", "memory [B]", "os", "kernel"} of this machine.
nlohmann::ordered_json host_description();

/// UTC time as "2026-11-20T05:12:00Z".
std::string utc_now();

/// The folder this executable lies in.
std::filesystem::path executable_folder();

/// fingertip-fem beside this executable; need not exist.
std::filesystem::path reference_program();

}  // namespace fingertip::studies
