/// Errors against the known curve, and the time each program needs for a given error.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "child_process.h"

namespace fingertip::benchmarks {

/// The known curve, SI, by increasing depth.
struct Truth {
  std::vector<double> depths;  ///< [m]
  std::vector<double> forces;  ///< [N]
};

/// Reads the columns `indentation_cm` and `normal_force_gf` of
/// tests/fem_reference/data/press_linear_frictionless.csv. Throws std::runtime_error when the file
/// cannot be read or has other columns.
Truth read_truth(const std::filesystem::path& file);

/// One program on one mesh.
struct Measurement {
  double mesh = 0.0;  ///< CalculiX: refinement of its one mesh; fingertip-fem: its tolerance
  std::size_t unknowns = 0;
  int iterations = 0;  ///< CalculiX only
  Cost cost;
  std::vector<double> errors;  ///< F/F_true - 1 per depth; empty unless every depth was reached
  /// Largest |error| over the depths; empty when a depth is missing.
  std::optional<double> worst_error() const;
};

/// F/F_true - 1 per depth, or nothing unless `forces` has one entry per depth.
std::vector<double> relative_errors(const std::vector<double>& forces, const Truth& truth);

/// A run's worst error and what it cost.
struct ErrorAndTime {
  double error = 0.0;
  double seconds = 0.0;
};

/// The runs that no other run beats or equals in both error and time, by increasing time: the
/// lower left envelope, along which the error falls strictly whatever the single runs do.
std::vector<ErrorAndTime> envelope(std::vector<ErrorAndTime> runs);

/// Time to reach `target`: along the envelope, log(time) linear in log(error) between its points.
/// When already the fastest run is better than `target`, its time, `at_most` set; nothing when no
/// run reaches it.
struct TimeToError {
  double seconds = 0.0;
  bool at_most = false;
};
std::optional<TimeToError> time_to_error(const std::vector<ErrorAndTime>& runs, double target);

}  // namespace fingertip::benchmarks
