/// Forces of a lattice against the continuum's at the depths of the verdict.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "meshes/press_response.h"

namespace fingertip::studies {

/// The depths at which forces are compared: 1/6, 1/3, 1/2, 2/3 and 1 of the press.
std::vector<double> verdict_depths(double depth);

/// Relative force errors at the verdict depths; null where a press did not get that far.
nlohmann::ordered_json force_errors(const meshes::PressResponse& response,
                                    const meshes::PressResponse& reference, double depth);

/// Estimated relative error of a continuum's force at a depth [m]: that of the nearest sample, for
/// it is known at samples only. NaN where it was not estimated.
double estimated_force_error(const meshes::PressResponse& continuum, double depth);

}  // namespace fingertip::studies
