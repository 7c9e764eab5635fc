/// What a fit hands on: a material.
#pragma once

#include "studies/run/fit_order.h"

namespace fingertip::studies {

/// The lattice and rubber that the estimates of `record` stand for, and where they hold.
calibration::Material material_of(const FitOrder& order, const calibration::FitRecord& record);

}  // namespace fingertip::studies
