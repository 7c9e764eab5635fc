/// Material tests from files of any layout, which a TOML file describes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/material_tests/material_test.h"

namespace fingertip::studies::inline measurements {

/// A cylinder between plates.
struct Plates {
  double diameter = 0.0, height = 0.0;  ///< at rest [m]
};

/// Compression up to which the force between plates that hold the ends is known (plate_factor.h):
/// beyond, the sides fold around the rims.
inline constexpr double deepest_stuck_compression = 0.4;

/// What the file says, in SI; files are read, averaged and converted.
struct MaterialTestFile {
  std::vector<calibration::MaterialTest> fitted, validation;
  /// Per fitted test, then per one held back: plates that hold the ends; none where they slip or
  /// there are none.
  std::vector<std::optional<Plates>> stuck;
  std::string material, source, licence;  ///< for people; may be empty
  std::vector<std::string> notes;         ///< what was left out or averaged
};

/// Reads
///
///   [about]  material, source, licence: texts
///   [data]   what tests have in common: any key of a test but `name` and `path`
///   [[test]] name, path (or a list of paths: repeats, averaged), use ("fit" or "predict"),
///            kind (of deformation; or "relaxation", "cycles", then with `deformation`),
///            separator ("comma", "semicolon", "tab", "whitespace"), skip (lines), header
///            (true, false), decimal ("point", "comma"), rows ([first, last] of the data),
///            strain = {column, is, sign}  is: stretch, engineering, logarithmic, displacement
///                                         (with unit), shear, volume-ratio, volume-change
///            stress = {column, is, unit, sign}  is: nominal, true, force, pressure
///            time = {column, unit, from}  from: ramp, hold; strain = {value, is, sign} where a
///                                         relaxation holds it
///            rate (quantity), sigma = {column, unit}, area, length, diameter, height, speed
///            (quantities), range ([from, to] of the strain as it stands in the file), points,
///            plates ("slip", "stick"),
///            published = {path, unit, LAW...}: sums of squares of other people's fits, in a file
///                                         of JSON, LAW = "its/place"
///
/// A column is a name of the header or a number from 1. `area` serves forces, `length` (gauge
/// length, or height) displacements and the rate; both follow from `diameter` and `height`. Paths
/// are relative to the file. Rows where the strain steps back are noise and left out; where more
/// than a tenth do, the curve turns back and `rows` must choose a branch. Repeats, and files of
/// more than 200 rows, become `points` (2 to 1000; 200) stresses at equal steps of the strain as it
/// stands in the files, from the largest start to the smallest end, by linear interpolation, and
/// their mean. Tests in time: timed_test.h. Throws InvalidInput naming file, line, key, value, rule
/// and remedy.
MaterialTestFile read_material_tests(const std::filesystem::path& file);

}  // namespace fingertip::studies::inline measurements
