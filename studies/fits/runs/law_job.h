/// Laws of rubber from material tests, as a job.
#pragma once

#include <string>
#include <vector>

#include "calibration/material_tests/law_fit.h"
#include "studies/config/loader.h"
#include "studies/jobs/job.h"
#include "studies/measurements/material_test_file.h"

namespace fingertip::studies::inline fits::inline runs {

/// Everything that the ranking depends on. SI.
struct LawInput {
  MaterialTestFile tests;
  std::vector<calibration::LawChoice> laws;
  calibration::LawFitOptions options;
};

/// Of calibration.tests, laws, weights, stretch_range and seed. Throws ConfigError with place and
/// key for what cannot be read or carried out.
LawInput law_input(const LoadedConfig& loaded);

/// Tests between plates that stick are fitted with the factors of the continuum (plate_factor.h),
/// whose runs are plates_LAW_N/ beside the job.
/// Files: laws.json, law_data.csv, material.toml (the card of the recommended law where it passed
/// its own tests), cards/LAW.toml (of every law that has a fit and whose coefficients make a
/// rubber; it says so where the fit failed), summary.json.
Job law_job(const LawInput& input);

}  // namespace fingertip::studies::inline fits::inline runs
