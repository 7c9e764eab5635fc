/// A measured relation between two quantities, and how uncertain it is.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "calibration/files/fit_file.h"

namespace fingertip::calibration::inline statistics {

/// A row of a measured file, as it stands there or in SI.
struct CurveRow {
  double x = 0.0, y = 0.0;  ///< of a test of a material strain and stress
  double sigma = 0.0;       ///< of y; 0: unknown, then in every row
  std::size_t line = 0;     ///< of the file
  double time = 0.0;        ///< 0 in every row where unknown
  int hold = 0;             ///< in which hold it was taken, from 1; 0: on the way
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
  /// Of a press: nobody has told the load cell's zero, and the file's rows or its description ask
  /// for it.
  bool zero_is_sought = false;
  bool in_time = false;  ///< values follow each other in time, and x may stand still
  LoadingHistory course = {};
};

/// Its y.
inline Eigen::Map<const Eigen::VectorXd> values_of(const Curve& curve) {
  return {curve.y.data(), Eigen::Index(curve.y.size())};
}

/// The place of a curve's first value among those of all.
template <typename Curves>
Eigen::Index first_value(const Curves& curves, std::size_t curve) {
  Eigen::Index first = 0;
  for (std::size_t i = 0; i < curve; ++i) first += Eigen::Index(curves[i].y.size());
  return first;
}

/// Lists of curves, one below the other.
inline Eigen::VectorXd stacked(const std::vector<Eigen::VectorXd>& lists) {
  Eigen::Index row = 0;
  for (const Eigen::VectorXd& list : lists) row += list.size();
  Eigen::VectorXd all(row);
  row = 0;
  for (const Eigen::VectorXd& list : lists) {
    all.segment(row, list.size()) = list;
    row += list.size();
  }
  return all;
}

inline double sum_of_squares(const std::vector<Eigen::VectorXd>& lists) {
  double sum = 0.0;
  for (const Eigen::VectorXd& list : lists) sum += list.squaredNorm();
  return sum;
}

/// The y of all curves, one below the other.
template <typename Curves>
Eigen::VectorXd all_values(const Curves& curves) {
  std::vector<Eigen::VectorXd> lists;
  for (const Curve& curve : curves) lists.emplace_back(values_of(curve));
  return stacked(lists);
}

}  // namespace fingertip::calibration::inline statistics
