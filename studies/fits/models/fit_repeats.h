/// Repeats among the curves of a fit.
#pragma once

#include <vector>

#include "calibration/press_fit/fit_record.h"
#include "calibration/press_fit/repeats.h"
#include "studies/fits/models/fit_input.h"

namespace fingertip::studies::inline fits::inline models {

/// Repeats are computed as one press: all take the depths of the one that went deepest.
void share_depths(FitInput& input);

/// The curves, in groups of presses that differ by nothing but their rows: the same finger,
/// obstacle, contact and machine.
std::vector<std::vector<std::size_t>> alike(const FitInput& input);

/// Of groups of two curves or more.
std::vector<calibration::Repeats> repeats_in(const FitInput& input,
                                             const calibration::CurveFit& fit);

/// What repeats leave, each with its own factor (calibration::apart).
calibration::CurveFit fit_apart(const FitInput& input, const calibration::CurveFit& fit,
                                const std::vector<calibration::Repeats>& repeats);

/// Whether repeats scatter by more than their errors.
bool scatter(const std::vector<calibration::Repeats>& repeats);

/// The fit once more, from where it ended, the scatter in the covariance of all values
/// (input.options.model_covariance): every repeat has a factor on its force, which no touch has to
/// take up, and what is found is that of their mean. `repeats` are sought again until they
/// stay; without sigma the values are weighed by what each repeat leaves of itself. Intervals of
/// the rubber are Student's of the number of repeats, of rigs the part that repeats make.
calibration::CurveFit fit_with_scatter(FitInput& input,
                                       const std::vector<calibration::ForwardModel*>& models,
                                       const calibration::CurveFit& first,
                                       std::vector<calibration::Repeats>& repeats);

/// What follows the search for `record.fit`: repeats, the fit with their scatter where they do,
/// options and intervals of the record. Returns the fit as repeats leave it each with its own
/// factor (fit_apart), which tells what the model misses.
calibration::CurveFit add_scatter_and_intervals(
    FitInput& input, const std::vector<calibration::ForwardModel*>& models,
    calibration::FitRecord& record);

}  // namespace fingertip::studies::inline fits::inline models
