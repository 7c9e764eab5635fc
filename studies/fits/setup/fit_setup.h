/// The input of a fit beside the configuration that it comes from.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "studies/config/loader.h"
#include "studies/fits/models/fit_input.h"
#include "studies/measurements/curve_file.h"

namespace fingertip::studies::inline fits::inline setup {

/// A fit's input as far as the configuration and measured files tell. The continuum of a curve
/// answers for it, makes its data (y is then still empty), or can judge the lattice.
struct FitSetup {
  LoadedConfig loaded;  ///< what is fitted: the configuration, or that at finite strain
  FitInput input;
  bool data_from_continuum = false;
  std::vector<std::vector<std::string>> settings;  ///< of measured or planned presses, as --set
  std::size_t held_back = 0;                       ///< of the curves, the last ones
  bool contact_known = true;                       ///< of all of them, not by default
  std::vector<std::string> notes;  ///< on measured files, strain and budget; for people
  std::shared_ptr<MeasuredFiles> files = std::make_shared<MeasuredFiles>();  ///< that were read
};

}  // namespace fingertip::studies::inline fits::inline setup
