/// The rows of tables that fits write.
#pragma once

#include <string>

#include "meshes/file_fields.h"
#include "meshes/press_response.h"

namespace fingertip::calibration {

/// fit_data.csv: a measured value, SI; x and measured are the curve's quantities.
struct FitDataRow {
  std::string curve;
  double x = meshes::unknown;
  double measured = meshes::unknown;
  double sigma = meshes::unknown;
  double fitted = meshes::unknown;
  double left_out = meshes::unknown;
};
constexpr auto fields_of(const FitDataRow*) {
  using meshes::field, meshes::Presence;
  using Row = FitDataRow;
  return std::tuple{
      field("curve", &Row::curve),       field("x", &Row::x),
      field("measured", &Row::measured), field("sigma", &Row::sigma, Presence::newer),
      field("fitted", &Row::fitted),     field("left_out", &Row::left_out, Presence::newer)};
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

}  // namespace fingertip::calibration
