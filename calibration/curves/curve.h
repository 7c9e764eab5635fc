/// A measured relation between two quantities, and how uncertain it is.
#pragma once

#include <string>
#include <vector>

namespace fingertip::calibration {

/// SI.
struct Curve {
  std::string name;  ///< for people; may be empty
  /// What is measured, with units; of a press the force along the plane's normal.
  std::string x_quantity = "indentation [m]", y_quantity = "force [N]";
  std::vector<double> x;  ///< positive, increasing
  std::vector<double> y;
  /// Standard deviation of every y, > 0; empty where unknown, in all curves of a fit or in none:
  /// then every y of every curve counts as equally uncertain.
  std::vector<double> sigma;
};

}  // namespace fingertip::calibration
