/// A measured relation between two quantities, and how uncertain it is.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "meshes/press/press_response.h"

namespace fingertip::calibration::inline statistics {

/// What a file tells besides the values that are fitted; SI, NaN where unknown.
struct Course {
  std::size_t rows = 0;            ///< of the file; 0: unknown
  double noise = meshes::unknown;  ///< standard deviation of a single row [y]
  double rows_per_value = 1.0;     ///< that were averaged
  /// Area between loading and unloading over the loading's work. Below 0 the way back lies above:
  /// no rubber gives work, it is the machine's play or lag, which shifts it by `play` [m].
  double loop = meshes::unknown, play = meshes::unknown;
  /// Of the longest hold under load: how long [s], and the share by which the force falls from that
  /// at the end of the loading; forces [y] over the time since then [s], thinned.
  double hold_time = meshes::unknown, relaxation = meshes::unknown;
  std::vector<double> held_time, held_y;
  std::vector<double> back_x, back_y;  ///< the way back, thinned
};

/// SI.
struct Curve {
  std::string name;  ///< for people; may be empty
  /// What is measured, with units; of a press the force along the plane's normal.
  std::string x_quantity = "indentation [m]", y_quantity = "force [N]";
  std::vector<double> x;  ///< increasing unless in_time; positive unless is_travel
  std::vector<double> y;
  /// Standard deviation of every y, > 0; empty where unknown, in all curves of a fit or in none:
  /// then every y of every curve counts as equally uncertain.
  std::vector<double> sigma;
  /// Of every value, from the first row on [s]; empty where unknown or of no interest.
  std::vector<double> time = {};
  bool is_travel = false;  ///< x is the travel of a machine, whose zero is anywhere
  bool in_time = false;    ///< values follow each other in time, and x may stand still
  Course course = {};
};

}  // namespace fingertip::calibration::inline statistics
