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

/// Whether repeats scatter by more than their errors.
bool scatter(const std::vector<calibration::Repeats>& repeats);

/// What follows the search for `record.fit`: repeats, the fit with their scatter where they do,
/// options and intervals of the record. Returns the fit as repeats leave it each with its own
/// factor (calibration::apart), which tells what the model misses.
calibration::CurveFit add_scatter_and_intervals(
    FitInput& input, const std::vector<calibration::ForwardModel*>& models,
    calibration::FitRecord& record);

}  // namespace fingertip::studies::inline fits::inline models
