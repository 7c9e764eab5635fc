/// Branches of a relaxation that data say nothing of.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "meshes/rubber/relaxation.h"

namespace fingertip::calibration::inline material {

/// A sentence for each branch faster or slower than the `times` that are observed [s].
std::vector<std::string> open_branches(const meshes::Relaxation& relaxation,
                                       const std::array<double, 2>& times);

}  // namespace fingertip::calibration::inline material
