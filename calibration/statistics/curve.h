/// A measured relation between two quantities, and how uncertain it is.
#pragma once

#include <string>
#include <vector>

#include "calibration/files/fit_file.h"

namespace fingertip::calibration::inline statistics {

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
  LoadingHistory course = {};
};

}  // namespace fingertip::calibration::inline statistics
