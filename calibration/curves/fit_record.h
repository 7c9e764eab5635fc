/// A fit to curves as it is kept: in plain words, as calibration.json and as fit_data.csv.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/curves/curve.h"
#include "calibration/curves/curve_checks.h"
#include "calibration/curves/curve_fit.h"
#include "calibration/material.h"

namespace fingertip::calibration {

/// Everything that is told of a fit.
struct FitRecord {
  std::string problem;                   ///< "curve", "experiment", "finite-strain", "damping"
  std::string forward;                   ///< "lattice", "continuum", "formula"
  Material material;                     ///< with the estimates put in
  std::optional<meshes::Rubber> target;  ///< where the data were made of a known rubber
  std::vector<Curve> curves;
  std::vector<std::string> conditions;  ///< a text per curve, may be empty
  CurveFitOptions options;
  CurveFit fit;
  std::vector<LeftOut> left_out;   ///< per curve, or none
  std::optional<Profile> profile;  ///< over these two:
  MaterialParameter profile_first{}, profile_second{};
  double wall_time = 0.0;  ///< [s]
};

/// Largest |measured - fitted| over |measured| of all curves, where that is not zero.
double worst_relative_residual(const FitRecord& record);

/// What was found, how sure that is, what the data leave open and whether the model describes them.
std::string fit_statement(const FitRecord& record);

/// calibration.json of the README, SI. Written atomically. Throws std::runtime_error when the file
/// cannot be written.
void write_fit_json(const FitRecord& record, const std::filesystem::path& file);

/// `curve,x,measured,sigma,fitted,left_out`, SI; empty cells where unknown. As above.
void write_fit_data(const FitRecord& record, const std::filesystem::path& file);

}  // namespace fingertip::calibration
