/// What the error of a lattice does to parameters that were fitted by it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibration/files/fit_file.h"
#include "calibration/statistics/curve.h"
#include "meshes/press/press_response.h"

namespace fingertip::studies::inline fits::inline runs {

/// The lattice's force at the estimates, minus the continuum's at the same E and G, at every x of
/// a curve [N]. `residuals` are measured minus the lattice's. Between the continuum's few samples
/// the relative error is taken as linear, beyond them as constant.
Eigen::VectorXd lattice_error(const calibration::Curve& curve, const std::vector<double>& residuals,
                              const meshes::PressResponse& continuum);

/// Adds to a fit every parameter's bias: -influence times `error` (of all curves, one below the
/// other). Intervals widen by its magnitude to both sides, and the statement says so.
void add_bias(const Eigen::VectorXd& error, calibration::FitFile& fit);

}  // namespace fingertip::studies::inline fits::inline runs
