/// The continuum as a forward model: pressed at the Poisson's ratios that a fit comes near.
#pragma once

#include <string>
#include <vector>

#include "calibration/press_fit/scaled_model.h"
#include "fem_reference/job/job.h"
#include "studies/jobs/job.h"

namespace fingertip::studies::inline fits::inline models {

/// `reference` at a Poisson's ratio, with its G and E = 2G(1 + nu), without fields. Depth, contact,
/// tilt, strain, law, mesh and tolerance are the job's. Throws InvalidInput, with the Poisson's
/// ratio in its value, for a job that is no static press or breaks a rule.
fem_reference::ReferenceJob at_ratio(const fem_reference::ReferenceJob& reference,
                                     double poissons_ratio);

/// The lowest Poisson's ratio that the job's law takes.
double lowest_ratio(const fem_reference::ReferenceJob& reference);

/// The model at the samples of the job. Its jobs are carried out by `context.run_all`, in
/// `place`/<Poisson's ratio>. `evaluate` throws InvalidInput for a response.csv that has other
/// samples than the job or forces that are not positive, and as the jobs do.
calibration::ScaledModel continuum_model(
    const fem_reference::ReferenceJob& reference,
    const std::vector<calibration::MaterialParameter>& parameters, const std::string& place,
    const JobContext& context,
    calibration::ScaledModel::Use use = calibration::ScaledModel::Use::search);

}  // namespace fingertip::studies::inline fits::inline models
