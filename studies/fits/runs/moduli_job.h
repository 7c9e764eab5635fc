/// Fits to the moduli and cubes under virtual tests as jobs.
#pragma once

#include "calibration/moduli/moduli_fit.h"
#include "lattice/model/constants.h"
#include "meshes/rubber/rubber.h"
#include "studies/jobs/job.h"

namespace fingertip::studies::inline fits::inline runs {

/// A fit to the moduli. Files: calibration.json, material.toml, summary.json.
Job moduli_job(const meshes::Rubber& rubber, const calibration::ModuliFitOptions& options);

/// Finite cubes of 2, 4 and 8 cells of the three models. File: cubes.csv.
Job cubes_job(const meshes::Rubber& rubber, const lattice::SpringConstants& central,
              const lattice::SpringConstants& hookean, double spacing);

}  // namespace fingertip::studies::inline fits::inline runs
