/// What speaks against a law that was fitted, in plain sentences (LawFit::contradictions).
#pragma once

#include "calibration/material_tests/law_fit.h"

namespace fingertip::calibration {

/// Of the fit itself; looks for instabilities and for branches that the tests do not reach.
void add_contradictions(LawFit& result, const LawFitOptions& options);

/// Predictions that miss, and loops that the law does not make, or makes too large.
void add_missed_predictions(LawFit& result);

}  // namespace fingertip::calibration
