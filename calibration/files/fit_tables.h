/// The rows of tables that fits write.
#pragma once

#include <string>
#include <utility>

#include "meshes/tables/file_fields.h"
#include "meshes/tables/table_rows.h"

namespace fingertip::calibration::inline files {

/// The name of a curve: in quotes whatever it says.
struct CurveName : std::string {
  CurveName() = default;
  CurveName(std::string text) : std::string(std::move(text)) {}
};
inline std::string csv_cell(const CurveName& name) {
  const std::string cell = meshes::csv_cell(name);
  return cell.starts_with('"') ? cell : '"' + cell + '"';
}

/// fit_data.csv: a measured value, SI; x and measured are the curve's quantities.
struct FitDataRow {
  CurveName curve;
  double x = meshes::unknown;
  double measured = meshes::unknown;
  double sigma = meshes::unknown;
  double fitted = meshes::unknown;
  double left_out = meshes::unknown;
  double indentation = meshes::unknown;  ///< of a press over travel, as fitted; 0 before touch
  double total_sigma = meshes::unknown;  ///< of sigma and the model's known errors together
  /// Measured minus fitted over total_sigma, errors that values share taken into account: the sum
  /// of the squares, and of the priors', is chi-square. Unknown without sigma.
  double whitened_residual = meshes::unknown;
};
consteval auto fields_of(const FitDataRow*) {
  return FINGERTIP_ALL_MEMBERS(FitDataRow, curve, x, measured, sigma, fitted, left_out, indentation,
                               total_sigma, whitened_residual)
      .newer("sigma left_out indentation total_sigma whitened_residual");
}

/// surrogate.csv: the smoothed force with its band.
struct SurrogateRow {
  double indentation = meshes::unknown;
  double force = meshes::unknown;
  double stiffness = meshes::unknown;
  double force_lower = meshes::unknown;
  double force_upper = meshes::unknown;
};
consteval auto fields_of(const SurrogateRow*) {
  return FINGERTIP_ALL_MEMBERS(SurrogateRow, indentation, force, stiffness, force_lower,
                               force_upper)
      .in("m", "indentation")
      .in("N", "force force_lower force_upper")
      .in("N/m", "stiffness");
}

}  // namespace fingertip::calibration::inline files
