/// manifest.json: what made a run.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "meshes/press/press_response.h"
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
constexpr auto fields_of(const Manifest*) {
  using meshes::if_known, meshes::named, meshes::newer;
  using Whole = Manifest;
  return std::tuple_cat(
      named("program version verb", &Whole::program, &Whole::version, &Whole::verb),
      newer(named("units", &Whole::units)),
      named("status command_line started finished source_hash input_hash packages host",
            &Whole::status, &Whole::command_line, &Whole::started, &Whole::finished,
            &Whole::source_hash, &Whole::input_hash, &Whole::packages, &Whole::host),
      if_known(named("exit_code error", &Whole::exit_code, &Whole::error)));
}

}  // namespace fingertip::studies::inline files
