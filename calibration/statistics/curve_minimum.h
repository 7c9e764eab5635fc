/// The search for the least loss.
#pragma once

#include <Eigen/Core>

#include "calibration/statistics/curve_residuals.h"
#include "calibration/statistics/fit_options.h"
#include "calibration/statistics/fit_result.h"

namespace fingertip::calibration::inline statistics {

/// Gauss–Newton steps from `start` as long as they keep what they promise, Levenberg–Marquardt by
/// Ceres from where they do not, and Gauss–Newton again, until a step promises less than a
/// ten-millionth of a standard error. Models whose slope or value jumps have minima at the jump,
/// where the promise stays and no step keeps it: there the search ends, too. Parameters that end at
/// a bound and are pushed against it are held there and the others sought again, until the set of
/// those held does not change: Ceres alone projects its step on the bounds, and can stop where
/// others still could move. Where options.max_iterations of either kind or the evaluations that
/// `residuals` may still make do not suffice, the least loss seen since the start is returned, not
/// converged. Throws as the models do at the start, Interrupted.
Minimum minimise(CurveResiduals& residuals, const CurveFitOptions& options,
                 const Eigen::VectorXd& start);

}  // namespace fingertip::calibration::inline statistics
