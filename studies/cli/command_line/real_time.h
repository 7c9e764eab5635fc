/// --real-time of press and live: a lattice that keeps up on this machine, and what it costs.
#pragma once

#include <string>
#include <vector>

#include "lattice/press/press_setup.h"
#include "studies/cli/command_line/command_line.h"
#include "studies/files/real_time_record.h"
#include "studies/presses/pace_trial.h"

namespace fingertip::studies::inline cli::inline command_line {

/// Settings of the live view and the page by itself, whatever a configuration says: a controller
/// moves the rod where a person wants it.
std::vector<std::string> as_a_person_presses();

/// What keeps up in the place of what `line` asks for.
struct RealTimeRun {
  LoadedConfig loaded;
  RealTimeRecord record;

  /// "real time: ..." for the screen and the log.
  std::string note() const;
  /// Writes real_time.json.
  void write(const std::filesystem::path& folder) const;
  /// Before anybody presses: the estimate from a tenth of the depth on.
  void estimate_force_error(const lattice::PressSetup& setup);
  /// The factor for the screen.
  std::string text() const;
};

/// Searches on this machine (search_pace_here), or takes the choice that a resumed run folder kept
/// for the same press. Throws ConfigError for a press without time, NotConverged where nothing
/// keeps up and --real-time demands it, and as search_pace_here.
RealTimeRun real_time_run(const CommandLine& line);

}  // namespace fingertip::studies::inline cli::inline command_line
