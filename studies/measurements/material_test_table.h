/// The tables of a file that describes material tests, and what its columns mean.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/material_tests/material_test.h"
#include "calibration/statistics/curve.h"
#include "studies/measurements/description.h"

namespace fingertip::studies::inline measurements {

enum class StrainMeasure { stretch, engineering, logarithmic, displacement, shear, ratio, change };

/// What the numbers of a column mean, or one number that is held.
struct StrainColumn {
  DescribedColumn described;    ///< without a column where a value is given
  std::optional<double> value;  ///< of a strain that is held [SI]
  StrainMeasure measure = StrainMeasure::stretch;
  double length = 1.0;  ///< that a displacement belongs to [m]

  /// "m" of a displacement, else "1".
  std::string si() const { return measure == StrainMeasure::displacement ? "m" : "1"; }
  /// Of a specimen at rest, in that unit.
  double at_rest() const {
    return measure == StrainMeasure::stretch || measure == StrainMeasure::ratio ? 1.0 : 0.0;
  }
  /// Of a number in that unit.
  double deformation(calibration::TestKind kind, double strain) const;
};
/// `may_hold`: whether a value may stand in place of the column.
StrainColumn strain_column(const TestTable& test, calibration::TestKind kind,
                           std::optional<double> length, bool may_hold);

struct StressColumn {
  DescribedColumn described;
  calibration::StressMeasure measure = calibration::StressMeasure::nominal;
  std::optional<double> area = {};  ///< that a force acts on [m²]; none: it is a stress

  std::string si() const { return area ? "N" : "Pa"; }
};
StressColumn stress_column(const TestTable& test, std::optional<double> area);

/// Those of a test; null: none.
struct TestColumns {
  const StrainColumn* strain = nullptr;  ///< without a column where a strain is held
  const StressColumn* stress = nullptr;
  const DescribedColumn *sigma = nullptr, *time = nullptr;
};

/// Numbers as they stand in the file, NaN for an empty cell, and what they are: x is the strain, y
/// the stress, or a force.
struct DescribedRows {
  std::vector<calibration::CurveRow> rows;
  ColumnUnit strain, stress, sigma, time;
};

/// The rows of the file's table, which must be the only one. `notes` tell what was found and passed
/// over. Throws InvalidInput with file and line.
DescribedRows described_rows(const FileText& text, const std::filesystem::path& file,
                             TableLayout layout, const TestColumns& columns,
                             std::vector<std::string>& notes);

}  // namespace fingertip::studies::inline measurements
