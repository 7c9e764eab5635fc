/// From a configuration to the input of a fit.
#pragma once

#include <string>

#include "studies/config/loader.h"
#include "studies/fits/setup/fit_setup.h"

namespace fingertip::studies::inline fits::inline setup {

/// Throws ConfigError with every problem of [calibration], of a condition or a measured file.
/// `files`: those that were read for another fit of them.
FitSetup fit_setup(const LoadedConfig& loaded,
                   const std::shared_ptr<MeasuredFiles>& files = std::make_shared<MeasuredFiles>());

/// The same of presses that are planned: no file is read, y and sigma are empty. Throws ConfigError
/// also for another problem than experiment.
FitSetup plan_setup(const LoadedConfig& loaded);

/// What finite strain adds to the deepest force, relative: a shell may be softer by it. `depth`:
/// the data's, over the rubber's thickness.
std::string strain_words(double depth, double excess);

}  // namespace fingertip::studies::inline fits::inline setup
