/// The rows of tables that fits write.
#pragma once

#include <string>
#include <utility>

#include "meshes/press/press_response.h"
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
constexpr auto fields_of(const FitDataRow*) {
  using meshes::field, meshes::Presence;
  using Row = FitDataRow;
  return std::tuple{field("curve", &Row::curve),
                    field("x", &Row::x),
                    field("measured", &Row::measured),
                    field("sigma", &Row::sigma, Presence::newer),
                    field("fitted", &Row::fitted),
                    field("left_out", &Row::left_out, Presence::newer),
                    field("indentation", &Row::indentation, Presence::newer),
                    field("total_sigma", &Row::total_sigma, Presence::newer),
                    field("whitened_residual", &Row::whitened_residual, Presence::newer)};
}

/// surrogate.csv: the smoothed force with its band.
struct SurrogateRow {
  double indentation = meshes::unknown;
  double force = meshes::unknown;
  double stiffness = meshes::unknown;
  double force_lower = meshes::unknown;
  double force_upper = meshes::unknown;
};
constexpr auto fields_of(const SurrogateRow*) {
  using meshes::field, meshes::Presence;
  using Row = SurrogateRow;
  return std::tuple{field("indentation [m]", &Row::indentation), field("force [N]", &Row::force),
                    field("stiffness [N/m]", &Row::stiffness),
                    field("force_lower [N]", &Row::force_lower),
                    field("force_upper [N]", &Row::force_upper)};
}

}  // namespace fingertip::calibration::inline files
