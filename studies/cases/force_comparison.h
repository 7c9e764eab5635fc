/// Forces of a press against those of a continuum or another press.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "meshes/press/press_response.h"

namespace fingertip::studies::inline cases {

/// The larger one; NaN when either is.
double larger(double a, double b);

/// The largest magnitude; NaN with a gap, or without values.
double largest(const std::vector<double>& values);

/// A force after the first loading of a program, beside the reference's at the same moment.
struct LaterForce {
  double stage = 0.0, time = 0.0, indentation = 0.0;  ///< time [s] since the press began
  double force = 0.0, reference_force = 0.0;          ///< [N]
  double error = 0.0;  ///< their difference over the reference's largest force
};

/// Depth by depth. NaN where a press did not get that far.
struct ForceComparison {
  std::vector<double> depth, force, reference_force;  ///< [m], [N]
  std::vector<double> reference_error;                ///< estimated, relative
  std::vector<double> error;                          ///< force over reference_force minus 1
  double l2_error = meshes::unknown;  ///< relative L2 error of the force curve, as far as both go
  std::vector<LaterForce> later;      ///< empty without a program, or where the stages differ
  /// Area of the loop of force and indentation over the reference's minus 1
  /// (work_along).
  double loop_error = meshes::unknown;
};

/// At `depths`.
ForceComparison compare_forces(const meshes::PressResponse& response,
                               const meshes::PressResponse& reference,
                               const std::vector<double>& depths);

/// The depths at which the core case compares: 1/6, 1/3, 1/2, 2/3 and 1 of the press.
std::vector<double> verdict_depths(double depth);

/// response.csv of a press; empty when there is none.
meshes::PressResponse response_in(const std::filesystem::path& folder);

}  // namespace fingertip::studies::inline cases
