/// Presses of the same finger in the same way: how far they scatter, and what that does to a fit.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "calibration/press_fit/rig_model.h"
#include "calibration/statistics/curve.h"
#include "calibration/statistics/fit_result.h"

namespace fingertip::calibration::inline press_fit {

/// From a fit without their scatter. `curves` have travels or indentations; `nuisance` are the
/// parameters of `fit` that a repeat has for itself, or shares with some (touch, zero, drift,
/// compliance); `touch` [m] and `zero` (force without load at every value [N]) are an entry per
/// curve of the fit.
Repeats repeats_of(const std::vector<std::size_t>& group, const std::vector<Curve>& curves,
                   const CurveFit& fit, const std::vector<std::size_t>& nuisance,
                   const std::vector<FitQuantity>& touch, const std::vector<Eigen::VectorXd>& zero);

}  // namespace fingertip::calibration::inline press_fit
