/// Measured displacements beside those of a study's presses: displacements.csv, distances.json. SI.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "meshes/shape/geometry.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::studies::inline files {

/// displacements.csv: a measured point of a press under a load. The rigid motion of the frame that
/// measured it is taken out; "" where it was not measured.
struct DisplacementRow {
  std::string name;
  double indentation = meshes::unknown;
  std::size_t point = 0;  ///< from 1
  meshes::Vector3 place = meshes::Vector3::Zero();
  meshes::Vector3 measured = meshes::Vector3::Zero();
  meshes::Vector3 computed = meshes::Vector3::Zero();
  double distance = meshes::unknown;
};
consteval auto fields_of(const DisplacementRow*) {
  return FINGERTIP_ALL_MEMBERS(DisplacementRow, name, indentation, point, place, measured, computed,
                               distance)
      .in("m", "indentation place measured computed distance")
      .called("place", "x,y,z");
}

/// Of all points, at one indentation.
struct DisplacementEntry {
  std::string name;  ///< of the press, or of the continuum
  double indentation = meshes::unknown;
  double rms = meshes::unknown, largest = meshes::unknown;  ///< of the distances [m]
  std::size_t farthest = 0;                                 ///< the point of the largest, from 1
  double size = meshes::unknown;                            ///< rms of what was measured [m]
  double ratio = meshes::unknown;  ///< of the measured field to the computed one, least squares
  double turn = meshes::unknown;   ///< of the frame [rad]
};
FINGERTIP_FIELDS(DisplacementEntry, name, indentation, rms, largest, farthest, size, ratio, turn);

/// Points at rest about the cubic grid that they were to stand on [m].
struct ScatterEntry {
  double rms = meshes::unknown, largest = meshes::unknown, pitch = meshes::unknown;
};
FINGERTIP_FIELDS(ScatterEntry, rms, largest, pitch);

/// Poisson's ratio from displacements, one fit.
struct RatioEntry {
  std::string name, folder, model, strain, freed;
  double poissons_ratio = meshes::unknown, lower = meshes::unknown, upper = meshes::unknown;
  bool at_bound = false;
  double noise = meshes::unknown, misfit = meshes::unknown;  ///< [m], over the displacements
  std::string statement;
};
FINGERTIP_FIELDS(RatioEntry, name, folder, model, strain, freed, poissons_ratio, lower, upper,
                 at_bound, noise, misfit, statement);

/// distances.json
struct DisplacementStudy {
  std::vector<DisplacementEntry> distances;
  std::optional<ScatterEntry> scatter_at_rest;
  std::vector<RatioEntry> poissons_ratios;
};
consteval auto fields_of(const DisplacementStudy*) {
  return FINGERTIP_ALL_MEMBERS(DisplacementStudy, distances, scatter_at_rest, poissons_ratios)
      .if_known("scatter_at_rest poissons_ratios");
}

}  // namespace fingertip::studies::inline files
