/// Presses in time, read back from their folders.
#pragma once

#include <string>
#include <vector>

#include "studies/report/figure/figure.h"
#include "studies/report/results/run_data.h"

namespace fingertip::studies::report::inline results {

/// One press, or one at rest; what its folder does not hold is empty.
struct MovingPress : PressFiles {
  std::string label;   ///< names it in figures and tables
  std::string status;  ///< "finished", or why not
  Style style;
  meshes::PressResponse response;        ///< of the lattice ...
  meshes::PressResponse reference;       ///< ... and of the continuum beside it
  std::string beside;                    ///< the press it is compared with; may be empty
  double change = meshes::unknown;       ///< largest relative difference of its forces from those
  double force_error = meshes::unknown;  ///< the same from the continuum's
  bool pictured = false;                 ///< whether its snapshots are to be drawn

  /// Largest commanded speed [m/s].
  double approach_speed() const;
  /// Whether its controller controls a force at some time.
  bool controls_force() const;
};

/// The press in `folder`. What is damaged stays empty and is noted in `reader`.
MovingPress read_moving_press(const std::filesystem::path& folder, const std::string& label,
                              FolderReader& reader);

/// The presses that `run`, a case on virtual control, lists in its summary.
std::vector<MovingPress> read_moving_presses(const RunData& run, FolderReader& reader);

/// The presses of a run's models; the last model's is pictured.
std::vector<MovingPress> presses_of_models(const RunData& run);

/// By how much the normal force exceeds the wanted one at most, relative to it, while the trace
/// says force mode; NaN without such rows.
double force_overshoot(const std::vector<lattice::TraceRow>& trace);
/// How often the trace changes between speed and force; NaN without rows.
double mode_switches(const std::vector<lattice::TraceRow>& trace);

}  // namespace fingertip::studies::report::inline results
