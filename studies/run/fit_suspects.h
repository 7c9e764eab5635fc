/// What the data of a fit may contain that its model leaves out.
#pragma once

#include <vector>

#include "calibration/curves/suspects.h"
#include "studies/run/fit_models.h"

namespace fingertip::studies {

/// Of measured presses: touch offset and zero of the force of every curve and compliance of every
/// machine where they are not fitted, drift where there are times, and what FitInput::excesses
/// knows (finite strain, the other contact). At the estimates of `fit`.
std::vector<calibration::Suspect> suspects_of(const FitInput& input,
                                              const calibration::CurveFit& fit,
                                              const FitModels& models);

}  // namespace fingertip::studies
