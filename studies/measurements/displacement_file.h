/// Measured displacements of material points, from CSV files or files of any layout that a TOML
/// file describes, into SI.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/press_fit/displacements.h"
#include "meshes/press/markers.h"

namespace fingertip::studies::inline measurements {

struct DisplacementFile {
  std::string name;                     ///< of the file without extension
  std::vector<meshes::Vector3> places;  ///< of the points at rest, along the finger's axes [m]
  std::vector<calibration::MeasuredDisplacements> samples;  ///< by increasing indentation
  /// Where the points were to stand on a cubic grid, in pitches; empty: on none.
  std::vector<meshes::Vector3> grid;
  std::vector<std::string> notes;  ///< what was ignored
  std::string sha256;              ///< of the measured file
};

/// Whether `entry` of calibration.data describes displacements: TOML with a table [place], or a CSV
/// file with columns displacement_x, y, z or moved_x, y, z.
bool has_displacements(const std::filesystem::path& entry);

/// A CSV file has a row per point and load: `indentation [UNIT]`, its place at rest `x`, `y`, `z`,
/// and `displacement_x`, `_y`, `_z`, or its place under the load, `moved_x`, `_y`, `_z`;
/// markers.csv of a press is one. Points are told apart by their places; one that a load lacks is
/// unknown there. A TOML file describes a table with a row per point:
///
///   path      of the table; separator, decimal, skip, header as of any table
///   middle    three lengths: where the middle of the points lies in the finger; without it the
///             table's own origin is the finger's
///   [place]   x, y, z = {column, unit, scale, sign} at rest, along the finger's axes
///   [grid]    i, j, k = {column, sign}: which point of a cubic grid it was to be
///   [[sample]] indentation, and x, y, z of the places under this load, or with
///             is = "displacement" of the displacements
///
/// Cells of x, y, z under a load may be empty. Throws InvalidInput with file, line, column and what
/// to do: unreadable, missing columns or units, cells that are no numbers, two points of one place,
/// two samples of one indentation, no sample.
DisplacementFile read_displacements(const std::filesystem::path& entry);

/// Displacements [m] of the points of `file` by a press whose markers they are, a field per sample;
/// empty where the press has no such sample.
std::vector<std::vector<meshes::Vector3>> fields_of(const std::vector<meshes::MarkerRow>& rows,
                                                    const DisplacementFile& file);

}  // namespace fingertip::studies::inline measurements
