/// Whether residuals look like noise.
#pragma once

#include <Eigen/Core>

#include "calibration/files/fit_file.h"

namespace fingertip::calibration::inline statistics {

/// Of one curve, in the order of its abscissae. A fit of p parameters makes about p changes of sign
/// by itself, so on few points per parameter the test sees less than it could.
ResidualStructure residual_structure(const Eigen::VectorXd& residuals);

}  // namespace fingertip::calibration::inline statistics
