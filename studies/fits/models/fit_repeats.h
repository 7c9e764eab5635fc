/// Errors of the values of a fit, and the repeats among its curves.
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

/// What follows the search for `record.fit`: repeats, and the fit once more with the errors that
/// its values show, noise, a smooth part that the model misses and a factor of every repeat
/// (calibration::value_errors); options and intervals of the record.
void add_errors_and_intervals(const FitInput& input,
                              const std::vector<calibration::ForwardModel*>& models,
                              calibration::FitRecord& record);

}  // namespace fingertip::studies::inline fits::inline models
