/// Zeros of stress and strain that nobody told: where they show, no law is accepted.
#pragma once

#include <optional>
#include <vector>

#include "calibration/material_tests/law_result.h"

namespace fingertip::calibration::inline material_tests {

/// Stress at rest that a test's own rows near rest tell, and its standard error [Pa]: a parabola in
/// neo-Hooke's stress through the lower third of its strains; none of fewer than six such rows, or
/// of a test that keeps the volume's change.
struct StressAtRest {
  double value = 0.0, error = 0.0;
};
std::optional<StressAtRest> stress_at_rest(const MaterialTest& test);

/// To a ranking of rank_laws: LawFit::with_free_zero of the laws of least AICc and of the simplest,
/// and why tests whose stress does not vanish at rest, or vanishes where their rows begin away from
/// it, are no law's: `failed` of all laws. Fits with a free zero of every test's stress, or of
/// every slow test's strain, must have an AICc lower by ten and a zero of four standard errors; of
/// a stress 1 % of the largest, with the rows near rest not against it; of a strain 5 % of the
/// largest, near to where a line through the least stresses vanishes.
void add_zeros_that_show(const std::vector<MaterialTest>& tests, std::vector<LawFit>& ranking,
                         const LawFitOptions& options = {});

}  // namespace fingertip::calibration::inline material_tests
