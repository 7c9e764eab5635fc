/// Poisson's ratio from measured displacements as a job.
#pragma once

#include <string>

#include "calibration/press_fit/displacement_fit.h"
#include "fem_reference/job/job.h"
#include "lattice/press/press_setup.h"
#include "studies/jobs/job.h"
#include "studies/measurements/displacement_file.h"

namespace fingertip::studies::inline fits::inline runs {

/// What was measured, and what answers for it: the press of `continuum`, or where `by_lattice` that
/// of `press`, a `hookean` or `network` lattice; both have the points as their markers and samples
/// at all indentations measured.
struct DisplacementFitInput {
  DisplacementFile measured;
  bool by_lattice = false;
  lattice::PressSetup press;
  fem_reference::ReferenceJob continuum;
  calibration::FrameMotion frame = calibration::FrameMotion::fitted;
  calibration::FreedPress freed = {};
  std::string place;  ///< stem of the folders of the continua that answer
};

/// Files: displacements.json (calibration/FORMATS.md), summary.json. Throws InvalidInput for
/// another lattice, and at run time as its presses and DisplacementMoments do.
Job displacement_job(const DisplacementFitInput& input);

}  // namespace fingertip::studies::inline fits::inline runs
