/// What a fit hands on: a material.
#pragma once

#include "studies/fits/models/fit_input.h"

namespace fingertip::studies::inline fits::inline runs {

/// The lattice and rubber that the estimates of `record` stand for, and where they hold.
calibration::Material material_of(const FitInput& input, const calibration::FitRecord& record);

}  // namespace fingertip::studies::inline fits::inline runs
