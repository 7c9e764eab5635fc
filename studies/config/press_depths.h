/// Depth, speed and samples of a press, by its program or by themselves.
#pragma once

#include "studies/config/loaded_config.h"

namespace fingertip::studies::inline config {

/// Samples make the depth, or the depth samples; of a program both and the speed follow, and a
/// default gives way to them. Appends a problem where what was given contradicts the program.
void resolve_depths(LoadedConfig& loaded, std::vector<meshes::Violation>& problems);

}  // namespace fingertip::studies::inline config
