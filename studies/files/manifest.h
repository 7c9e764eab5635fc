/// manifest.json: what made a run.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "meshes/tables/file_fields.h"

namespace fingertip::studies::inline files {

/// manifest.json; an exit code when the run has ended.
struct Manifest {
  std::string program, version, verb, units, status;
  std::vector<std::string> command_line;
  std::string started;
  std::optional<std::string> finished;
  std::string source_hash, input_hash;
  nlohmann::ordered_json packages, host;
  std::optional<int> exit_code;
  std::string error;

  bool empty() const { return program.empty(); }
};
consteval auto fields_of(const Manifest*) {
  return FINGERTIP_ALL_MEMBERS(Manifest, program, version, verb, units, status, command_line,
                               started, finished, source_hash, input_hash, packages, host,
                               exit_code, error)
      .newer("units")
      .if_known("exit_code error");
}

}  // namespace fingertip::studies::inline files
