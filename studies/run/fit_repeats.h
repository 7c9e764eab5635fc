/// Repeats among the curves of a fit.
#pragma once

#include <vector>

#include "calibration/curves/repeats.h"
#include "studies/run/fit_input.h"

namespace fingertip::studies {

/// Repeats are computed as one press: all take the depths of the one that went deepest.
void share_depths(FitInput& input);

/// Groups of two curves or more of presses that differ by nothing but their rows: the same finger,
/// obstacle, contact and machine.
std::vector<calibration::Repeats> repeats_in(const FitInput& input,
                                             const calibration::CurveFit& fit);

/// What repeats leave, each with its own factor (calibration::apart).
calibration::CurveFit fit_apart(const FitInput& input, const calibration::CurveFit& fit,
                                const std::vector<calibration::Repeats>& repeats);

/// Whether repeats scatter by more than their errors.
bool scatter(const std::vector<calibration::Repeats>& repeats);

/// The fit once more, from where it ended, the scatter in the covariance of all values
/// (input.options.model_covariance): every repeat has a factor on its force, which no touch has to
/// take up, and what is found is that of their mean. Without sigma the values are weighed by what
/// each repeat leaves of itself, and `repeats` are sought again until they stay. The part of the
/// intervals that repeats make is Student's of their number.
calibration::CurveFit fit_with_scatter(FitInput& input,
                                       const std::vector<calibration::ForwardModel*>& models,
                                       const calibration::CurveFit& first,
                                       std::vector<calibration::Repeats>& repeats);

}  // namespace fingertip::studies
