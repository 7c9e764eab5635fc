/// Curves of stress over strain as they stand in files: cleaned, and averaged over repeats.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "calibration/statistics/curve.h"

namespace fingertip::calibration::inline material_tests {

/// Strains x and stresses y in a file's own units, signs and order; NaN where a cell is empty.
using StrainCurve = std::vector<CurveRow>;

/// How many points were left out.
struct CurveCleaning {
  std::size_t empty = 0, outside = 0, backward = 0;
};

/// Leaves out points with an empty cell, outside of `range` of the strain, and those whose strain
/// is not beyond all before it, in the direction in which the curve goes on the whole.
CurveCleaning clean(StrainCurve& curve, const std::optional<std::array<double, 2>>& range);

/// Mean stress at `points` >= 2 equal steps of the strain that all curves reach, each interpolated
/// linearly. Curves are cleaned, of two points or more, and go in one direction; none where they
/// do not, or have no strain in common.
std::optional<StrainCurve> mean_curve(const std::vector<StrainCurve>& curves, std::size_t points);

}  // namespace fingertip::calibration::inline material_tests
