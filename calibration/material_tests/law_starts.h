/// Where the search for a law's coefficients begins.
#pragma once

#include <vector>

#include "calibration/curves/curve_fit.h"
#include "calibration/material_tests/law_fit.h"

namespace fingertip::calibration {

/// Free coefficients with starts, sizes and bounds, and further starts; `scales` per test and
/// point. For held exponents a law of Ogden is linear in mu_i >= 0, which the non-negative least
/// squares find; exponents are drawn at random and the best sets kept.
CurveFitOptions law_starts(const std::vector<MaterialTest>& tests,
                           const std::vector<std::vector<double>>& scales, const LawChoice& choice,
                           const LawFitOptions& options);

}  // namespace fingertip::calibration
