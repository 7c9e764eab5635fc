/// A fit to curves as a job.
#pragma once

#include <nlohmann/json.hpp>

#include "studies/fits/models/fit_input.h"
#include "studies/jobs/job.h"

namespace fingertip::studies::inline fits::inline runs {

/// What the fit has found, as a material, whether it may be used or not.
inline constexpr const char* estimates_name = "estimates.toml";

/// The fit. Files: calibration.json, estimates.toml (a material.toml, which says so where the fit
/// failed its own tests; none where the estimates are no material), fit_data.csv, summary.json;
/// while it runs, evaluations/, from which it goes on when it is run again in the same folder.
Job fit_job(const FitInput& input);

}  // namespace fingertip::studies::inline fits::inline runs
