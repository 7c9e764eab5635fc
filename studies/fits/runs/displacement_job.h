/// Poisson's ratio from measured displacements as a job.
#pragma once

#include "studies/fits/setup/fit_displacements.h"
#include "studies/jobs/job.h"

namespace fingertip::studies::inline fits::inline runs {

/// Files: displacements.json (calibration/FORMATS.md), summary.json; what is computed at the ratio
/// found, with what is freed, beside what was measured: displacements.csv, distances.json. Throws
/// InvalidInput for another lattice, and at run time as its presses and DisplacementMoments do.
Job displacement_job(const DisplacementFitInput& input);

}  // namespace fingertip::studies::inline fits::inline runs
