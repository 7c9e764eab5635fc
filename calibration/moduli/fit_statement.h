/// The plain words of a calibration.
#pragma once

#include <Eigen/Core>
#include <string>

#include "calibration/moduli/moduli_fit.h"

namespace fingertip::calibration::inline moduli {

/// What `fit` reached, why it cannot reach more, which constants the tests leave open and how the
/// choice among them was made; SI.
std::string fit_statement(const ModuliFit& fit);

/// A direction of (k1, k2, k3, kappa) in words: "k1 + 1, k2 - 1, k3 + 0.75", scaled so that its
/// largest component is 1.
std::string describe_direction(const Eigen::Vector4d& direction);

}  // namespace fingertip::calibration::inline moduli
