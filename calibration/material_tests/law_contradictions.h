/// What speaks against a law that was fitted, in plain sentences (LawFit::contradictions).
#pragma once

#include <string>
#include <vector>

#include "calibration/material_tests/law_result.h"

namespace fingertip::calibration::inline material_tests {

/// Of the fit to `tests`, whose sought zeros are taken off: instabilities, open coefficients,
/// branches and G, doubts of files, slack, what it misses, tests that contradict each other, do not
/// go through rest, or whose stress falls.
void add_contradictions(LawFit& result, const std::vector<MaterialTest>& tests,
                        const LawFitOptions& options);

/// LawFit::untested of a fit to `tests`.
std::vector<UntestedMode> untested_modes(const LawFit& fit, const std::vector<MaterialTest>& tests,
                                         const LawFitOptions& options);

/// How far laws that meet the tests alike differ where these know one way of deforming alone and
/// none was held back.
void add_differences(const std::vector<const LawFit*>& laws, std::vector<LawFit>& ranking);

/// Predictions that miss, and loops that the law does not make, or makes too large.
void add_missed_predictions(LawFit& result);

}  // namespace fingertip::calibration::inline material_tests
