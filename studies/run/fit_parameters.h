/// The parameters that a fit seeks: which are free, where they start, how far they may go.
#pragma once

#include <vector>

#include "studies/run/fit_setup.h"

namespace fingertip::studies {

/// Whether presses of a rubber that relaxes tell its relaxation besides.
inline bool knows_relaxation(const CalibrationSettings& settings) {
  return settings.problem == CalibrationProblem::experiment;
}

/// Of calibration.parameters, else the usual ones, with starts and priors from `base`. Throws
/// ConfigError for one that the problem does not know.
std::vector<calibration::FreeParameter> free_list(const LoadedConfig& loaded,
                                                  const lattice::PressSetup& base);

/// Bounds of Poisson's ratio go into the fit's options, and as bounds into those of E or G where
/// the other one is held. Throws ConfigError for a held ratio outside of its range.
void bound_poissons_ratio(const LoadedConfig& loaded, FitInput& input);

/// E and G enter together: whatever is fitted, a second rubber may look alike (calibration/README).
std::vector<double> start_ratios(const FitInput& input);

}  // namespace fingertip::studies
