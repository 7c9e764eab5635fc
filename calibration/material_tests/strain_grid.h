/// Curves of stress over strain of several specimens: their mean and their scatter.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "calibration/statistics/curve.h"

namespace fingertip::calibration::inline material_tests {

/// Strains x, growing or falling from row to row, and stresses y.
using StrainCurve = std::vector<CurveRow>;

/// Mean stress at `points` >= 2 equal steps of the strain that all curves reach, each interpolated
/// linearly. Curves have two points or more; none where they go in different directions, or have no
/// strain in common.
std::optional<StrainCurve> mean_curve(const std::vector<StrainCurve>& curves, std::size_t points);

/// Of every curve the least squares factor on the mean's stresses.
std::vector<double> factors_of(const std::vector<StrainCurve>& curves, const StrainCurve& mean);

/// Standard deviation of factors between specimens; 0 for less than two.
double scatter_of(const std::vector<double>& factors);

/// Standard deviation of a mean of so many specimens, over it, by which the normal distribution
/// tells the 95 % interval that Student's t has for n - 1: t s / (1.96 sqrt(n)).
double error_of_mean(const std::vector<double>& factors);

}  // namespace fingertip::calibration::inline material_tests
