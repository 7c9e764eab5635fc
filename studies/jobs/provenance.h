/// What a result was made with: program, packages, machine.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace fingertip::studies::inline jobs {

/// The program's version, e.g. "0.1.0".
std::string program_version();

/// Versions of the libraries this program and fingertip-fem (when built) were compiled with.
nlohmann::ordered_json package_versions();

/// {"cpu", "cores", "memory [B]", "os", "kernel"} of this machine.
nlohmann::ordered_json host_description();

double memory_of_machine();  ///< [byte]
/// Below it nobody is told what a computation takes [byte].
inline constexpr double shown_memory = 1e9;

/// UTC time as "2026-11-20T05:12:00Z".
std::string utc_now();

}  // namespace fingertip::studies::inline jobs
