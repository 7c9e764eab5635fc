/// Material parameters from measured curves, with what the data can and cannot say.
#pragma once

#include <vector>

#include "calibration/statistics/curve.h"
#include "calibration/statistics/fit_options.h"
#include "calibration/statistics/fit_result.h"
#include "calibration/statistics/forward_model.h"

namespace fingertip::calibration::inline statistics {

/// Least squares by Ceres with the models' own Jacobians; a model per curve, whose parameters are
/// `options.free` in that order. Throws InvalidInput for an empty curve, lists of different length,
/// abscissae that are not positive and increasing, values that are not finite, sigma that is not
/// positive, a robust loss without sigma, a start outside its bounds, fewer values than
/// parameters, and for what a model refuses at the first start; NotConverged where it has no answer
/// there; Interrupted. Iterations or evaluations that do not suffice are told by `converged`.
CurveFit fit_curves(const std::vector<Curve>& curves, const std::vector<ForwardModel*>& models,
                    const CurveFitOptions& options);

}  // namespace fingertip::calibration::inline statistics
