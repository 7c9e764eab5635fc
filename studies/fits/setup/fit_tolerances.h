/// Tolerances of what describes the presses, as known errors of their forces.
#pragma once

#include <vector>

#include "studies/fits/setup/fit_setup.h"

namespace fingertip::studies::inline fits::inline setup {

/// Adds to the known errors of measured or planned presses those of calibration.tolerances and of
/// Poisson's ratio where it is held: within calibration.poisson_range where that is given, from
/// 0.45 to 0.4999 where the rubber's keys do not tell it. Throws ConfigError for a tolerance of
/// what no press has, or that is none.
void add_tolerances(const LoadedConfig& loaded, FitInput& input);

/// FitCurve::known_errors of a further press of `input`'s rubber: those of numbers that it shares
/// with the presses of the fit, and of the models as at the deepest of the first one.
std::vector<std::vector<double>> known_errors_of(const FitInput& input,
                                                 const lattice::PressSetup& press);

}  // namespace fingertip::studies::inline fits::inline setup
