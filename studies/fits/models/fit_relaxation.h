/// Fits of presses whose rubber relaxes: what is known of its branches and what is sought.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "calibration/statistics/curve.h"
#include "calibration/statistics/fit_options.h"
#include "meshes/rubber/relaxation.h"
#include "studies/config/loader.h"
#include "studies/fits/models/fit_input.h"

namespace fingertip::studies::inline fits::inline models {

/// The word of calibration.parameters for shares and times of all branches.
inline constexpr const char* relaxation_word = "relaxation";

/// The configuration with its rubber after long times, which is what presses in equilibrium know.
LoadedConfig in_equilibrium(const LoadedConfig& loaded);

/// What the word stands for: shares and times of the branches of rubber.relaxation, of one if there
/// are none.
std::vector<calibration::MaterialParameter> relaxation_sought(const LoadedConfig& loaded);

/// Branches of a fit with `free` parameters: those of rubber.relaxation, and such as are free;
/// none: the rubber does not relax. Throws ConfigError where a share or time is neither free nor
/// given, and for a bulk modulus that does not fade, which Lee & Radok's integral does not know.
std::vector<calibration::FitBranch> branches_of(
    const LoadedConfig& loaded, const std::vector<calibration::FreeParameter>& free);

/// From the shortest to the longest time that the curves tell of [s].
std::array<double, 2> observed_times(const std::vector<FitCurve>& curves);

/// Starts and bounds of free shares and times, from the holds and times of the curves; those of
/// branches that `loaded` gives start there.
void start_branches(const LoadedConfig& loaded, FitInput& input);

/// Beside the start those with the free times of branches four times shorter and longer: between
/// them lie other valleys. Only where the models answer at once (asks_one_press).
void add_starts_in_time(FitInput& input);

/// The branches at the estimates; empty: the rubber does not relax.
meshes::Relaxation relaxation_of(const FitInput& input, const Eigen::VectorXd& estimates);

}  // namespace fingertip::studies::inline fits::inline models
