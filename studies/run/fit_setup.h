/// From a configuration to the input of a fit.
#pragma once

#include <string>
#include <vector>

#include "fem_reference/job.h"
#include "studies/config/loader.h"
#include "studies/run/fit_input.h"

namespace fingertip::studies {

/// A fit's input as far as the configuration and measured files tell. The continuum of a curve
/// answers for it, makes its data (y is then still empty), or can judge the lattice.
struct FitSetup {
  LoadedConfig loaded;  ///< what is fitted: the configuration, or that at finite strain
  FitInput input;
  bool data_from_continuum = false;
  std::vector<std::vector<std::string>> settings;  ///< of measured or planned presses, as --set
  bool contact_known = true;                       ///< of all of them, not by default
  std::vector<std::string> notes;  ///< on measured files, strain and budget; for people
};

/// Throws ConfigError with every problem of [calibration], of a condition or a measured file.
FitSetup fit_setup(const LoadedConfig& loaded);

/// The same of presses that are planned: no file is read, y and sigma are empty. Throws ConfigError
/// also for another problem than experiment.
FitSetup plan_setup(const LoadedConfig& loaded);

/// What finite strain adds to the deepest force, relative: a shell may be softer by it. `depth`:
/// the data's, over the rubber's thickness.
std::string strain_words(double depth, double excess);

/// The continuum beside a press: static, linear or law A as `kinematics` says, without fields.
fem_reference::ReferenceJob continuum_beside(const LoadedConfig& loaded,
                                             lattice::Kinematics kinematics);

}  // namespace fingertip::studies
