/// Numbers that describe presses and are known within a tolerance: sizes, place, Poisson's ratio.
#pragma once

#include <vector>

#include "studies/fits/models/fit_input.h"

namespace fingertip::studies::inline fits::inline models {

/// Whether any press of the fit has it.
bool any_has(const FitInput& input, calibration::Described number);

/// Whether the press has the number, and it is `value`.
bool has_value(const lattice::PressSetup& press, calibration::Described number, double value);

/// A number whose error is a step, or anywhere between two values: an error for each value that it
/// has among the presses, which share it; where there are several their names tell the value.
std::vector<KnownError> by_value(const KnownError& error, const FitInput& input);

/// What one step of it does to the forces of a press at every sample, relative
/// (calibration::change_between); empty where the press has another value. Throws as that does.
std::vector<double> changes_of(const KnownError& error, const lattice::PressSetup& press);

/// Numbers whose error is not among the known ones, each with a step to tell: a hundredth of every
/// radius, of the scale of what is no dome, and of Poisson's ratio where it is held.
std::vector<KnownError> untold_numbers(const FitInput& input);

}  // namespace fingertip::studies::inline fits::inline models
