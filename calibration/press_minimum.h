/// The search for the least loss.
#pragma once

#include <Eigen/Core>

#include "calibration/press_fit.h"
#include "calibration/press_residuals.h"

namespace fingertip::calibration {

/// E, G, bond and contact, which are positive by nature.
bool varies_by_logarithm(const FreeParameter& free);
/// `scale`, or |start|.
double size_of(const FreeParameter& free);
/// `lower`, or zero where the parameter cannot be negative.
double lower_bound(const FreeParameter& free);

/// Levenberg–Marquardt by Ceres from `start`. Parameters that end at a bound and are pushed against
/// it are held there and the others sought again, until the set of those held does not change:
/// Ceres alone projects its step on the bounds, and can stop where others still could move. Throws
/// as the models do at the start, NotConverged when options.max_iterations do not suffice.
Minimum minimise(PressResiduals& residuals, const PressFitOptions& options,
                 const Eigen::VectorXd& start);

}  // namespace fingertip::calibration
