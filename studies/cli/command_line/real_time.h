/// --real-time of press and live: a lattice that keeps up on this machine, and what it costs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "meshes/press/press_response.h"
#include "studies/cli/command_line/command_line.h"
#include "studies/files/real_time_record.h"
#include "studies/jobs/session.h"
#include "studies/presses/pace_trial.h"

namespace fingertip::studies::inline cli::inline command_line {

/// What keeps up in the place of what `line` asks for.
struct RealTimeRun {
  LoadedConfig loaded;
  RealTimeRecord record;

  /// "--real-time: ..." for the screen and the log.
  std::string note() const;
  /// Writes real_time.json.
  void write(const std::filesystem::path& folder) const;
  /// Has `session` press the continuum and the lattice at rest, where that takes seconds, and keeps
  /// the force errors; with `response` also those of this press.
  void find_force_error(Session& session, const std::optional<meshes::PressResponse>& response);
  /// Factors and force errors for the screen.
  std::string text() const;
};

/// Searches on this machine (search_pace_here), or takes the choice that a resumed run folder kept
/// for the same press. Throws ConfigError for a press without time, and as search_pace_here.
RealTimeRun real_time_run(const CommandLine& line);

}  // namespace fingertip::studies::inline cli::inline command_line
