/// The parameters that a fit seeks: which are free, where they start, how far they may go.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "studies/fits/setup/fit_setup.h"

namespace fingertip::studies::inline fits::inline setup {

/// Whether presses of a rubber that relaxes tell its relaxation besides.
inline bool knows_relaxation(const CalibrationSettings& settings) {
  return settings.problem == CalibrationProblem::experiment;
}

/// Of calibration.parameters, else the usual ones, with starts and priors from `base`: E or G alone
/// as `modulus`. Throws ConfigError for one that the problem does not know.
std::vector<calibration::FreeParameter> free_list(const LoadedConfig& loaded,
                                                  const lattice::PressSetup& base);

/// What is held where calibration.parameters names E or G alone, for people.
std::optional<std::string> held_ratio_note(const LoadedConfig& loaded, const FitInput& input);

/// Bounds of Poisson's ratio go into the fit's options. Throws ConfigError for a held ratio outside
/// of its range.
void bound_poissons_ratio(const LoadedConfig& loaded, FitInput& input);

/// E and G enter together: whatever is fitted, a second rubber may look alike
/// (calibration/moduli/README).
std::vector<double> start_ratios(const FitInput& input);

}  // namespace fingertip::studies::inline fits::inline setup
