/// The calibrated lattice's force and stiffness as one smooth curve.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibration/material/material_parameter.h"
#include "lattice/press/press_setup.h"
#include "studies/jobs/job.h"

namespace fingertip::studies::inline fits::inline runs {

/// How sure the forces of a press are.
struct ForceUncertainty {
  std::vector<calibration::MaterialParameter> parameters;  ///< may be empty
  Eigen::MatrixXd covariance;                              ///< of them
  double model_error = 0.0;                                ///< relative, counted as one deviation
};

/// A static press of `setup`, calibrated, to its depth. Files: surrogate.csv, surrogate.json,
/// summary.json.
Job surrogate_job(const lattice::PressSetup& setup, const ForceUncertainty& uncertainty);

}  // namespace fingertip::studies::inline fits::inline runs
