/// What presses would tell before they are made, as a job.
#pragma once

#include "studies/fits/models/fit_input.h"
#include "studies/jobs/job.h"

namespace fingertip::studies::inline fits::inline runs {

inline constexpr const char* plan_name = "plan.json";

/// The noise that is stated for forces: relative, and absolute [N].
struct PlannedNoise {
  double relative = 0.0, absolute = 0.0;
};

/// `input` of plan_setup, with the rubber and rig that its free parameters start at. Files:
/// plan.json, planned_presses.csv (`press,x,force,sigma`, SI), summary.json; while it runs
/// evaluations/ and next/, from which it goes on. Throws InvalidInput for noise that is zero.
Job plan_job(const FitInput& input, const PlannedNoise& noise);

}  // namespace fingertip::studies::inline fits::inline runs
