/// real_time.json: what --real-time of press and live chose, and what it costs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "meshes/tables/file_fields.h"
#include "studies/files/press_summary.h"

namespace fingertip::studies::inline files {

/// A short press on this machine.
struct PaceTrialEntry {
  double spacing = meshes::unknown, step = meshes::unknown;  ///< [m], [s]
  long threads = 1;
  double real_time_factor = meshes::unknown;  ///< in its slowest 10 ms
};
FINGERTIP_FIELDS(PaceTrialEntry, spacing, step, threads, real_time_factor);

/// real_time.json in a run folder, and `real_time` in summary.json; SI.
struct RealTimeRecord {
  std::string asked;  ///< press and threads that were asked for, as a key
  double spacing_asked = meshes::unknown, spacing = meshes::unknown;
  std::string integrator;
  double step = meshes::unknown;
  long threads = 1;
  double expected_factor = meshes::unknown;
  bool tried = false;  ///< expected from a trial at this spacing, else from coarser ones
  std::vector<PaceTrialEntry> trials;
  /// Of the run, in the slowest 10 ms (live: half second) and as a whole; 1 is the most of a live
  /// view.
  double slowest_factor = meshes::unknown, whole_factor = meshes::unknown;
  std::optional<ForceErrorEntry> force_error;
};
consteval auto fields_of(const RealTimeRecord*) {
  return FINGERTIP_ALL_MEMBERS(RealTimeRecord, asked, spacing_asked, spacing, integrator, step,
                               threads, expected_factor, tried, trials, slowest_factor,
                               whole_factor, force_error)
      .if_known("slowest_factor whole_factor force_error");
}

inline constexpr const char* real_time_name = "real_time.json";

}  // namespace fingertip::studies::inline files
