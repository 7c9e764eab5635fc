/// Where the search for a law's coefficients begins.
#pragma once

#include <vector>

#include "calibration/material_tests/law_result.h"
#include "calibration/statistics/fit_options.h"

namespace fingertip::calibration::inline material_tests {

/// Free coefficients with starts, sizes and bounds, and further starts; `scales` per test and
/// point. For held exponents a law of Ogden is linear in mu_i >= 0, which the non-negative least
/// squares find; exponents are drawn at random and the best sets kept.
CurveFitOptions law_starts(const std::vector<MaterialTest>& tests,
                           const std::vector<std::vector<double>>& scales, const LawChoice& choice,
                           const LawFitOptions& options);

/// The next simpler laws, of as many branches, that are cases of this one.
std::vector<LawChoice> nested_laws(const LawChoice& choice);

/// Coefficients of `choice` that make it a nested law of `coefficients`, nearly where it would have
/// to be at a bound; several where a further exponent may be anything.
std::vector<Eigen::VectorXd> as_more_general(const LawChoice& nested,
                                             const Eigen::VectorXd& coefficients,
                                             const LawChoice& choice);

/// A start that a search may begin from.
Eigen::VectorXd within_bounds(Eigen::VectorXd start, const std::vector<FreeParameter>& free);

}  // namespace fingertip::calibration::inline material_tests
