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
///   [[test]] name, path (or a list of paths: specimens), use ("fit" or "predict"),
///            kind (of deformation; or "relaxation", "cycles", then with `deformation`),
///            separator ("comma", "semicolon", "tab", "whitespace"), skip (lines), header
///            (true, false), decimal ("point", "comma"), rows ([first, last] of the data),
///            strain = {column, is, unit, scale, sign, zero}  is: stretch, engineering,
///                                         logarithmic, displacement, shear, volume-ratio,
///                                         volume-change
///            stress = {column, is, ...}   is: nominal, true, force, pressure
///            time = {column, ..., from}   from: ramp, hold; strain = {value, is, unit, sign} where
///                                         a relaxation holds it
///            rate (quantity), sigma = {column, ...}, area, length, diameter, height, speed
///            (quantities), range ([from, to] of the strain as it stands in the file), points,
///            plates ("slip", "stick"),
///            published = {path, unit, LAW...}: sums of squares of other people's fits, in a file
///                                         of JSON, LAW = "its/place"
///
/// Columns: DescribedColumn. `area` serves forces, `length` (gauge length, or height) displacements
/// and the rate; both follow from `diameter` and `height`. Paths are relative to the file. Of slow
/// tests that go to one side of rest rows are treated as those of a press: odd ones, a load cell at
/// its limit, reverse order; rows at rest tell the stress's zero where no key does; of cycles the
/// first loading is taken, holds are left out. More than `points` (2 to 1000; 200) rows are
/// averaged in as many bins. Of several specimens the mean at `points` equal steps of the strain
/// that all reach is one test, which knows their scatter. Stretches beyond 12 are doubted. Tests in
/// time: timed_test.h. Throws InvalidInput naming file, line, key, value, rule and remedy.
MaterialTestFile read_material_tests(const std::filesystem::path& file);

}  // namespace fingertip::studies::inline measurements
