/// Presses that are not made yet: those of a plan, and candidates beside a fit.
#pragma once

#include <string>
#include <vector>

#include "studies/fits/setup/fit_setup.h"

namespace fingertip::studies::inline fits::inline setup {

/// A curve without forces per condition, named by the file of calibration.data that will hold it,
/// where files are named. Its x are indentations, press.samples or else calibration.points even
/// ones to press.depth; where calibration.rig is given it becomes one over travel. Throws
/// ConfigError as measured files do.
void add_planned_curves(FitSetup& fit, const LoadedConfig& loaded);

/// What calibration.candidates names, as far as the first press of the fit is not it already:
///   repeat   the first press again
///   shallow  half as deep
///   deep     half as deep again
///   blank    a rigid one in the finger's place, where a compliance is fitted
///   ball     of 0.4 of the finger's radius, no deeper than half its own
///   plane
///   contact  sticking in place of slipping, or the other way round
/// and conditions. Presses that only a continuum in three dimensions knows are left out unless they
/// are given as conditions. One that breaks a rule says so in `refused`. Throws ConfigError for a
/// word that is none of these.
std::vector<Candidate> candidates_of(const LoadedConfig& loaded, const FitSetup& fit);

}  // namespace fingertip::studies::inline fits::inline setup
