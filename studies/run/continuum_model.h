/// The continuum as a forward model: pressed at the Poisson's ratios that a fit comes near.
#pragma once

#include <string>
#include <vector>

#include "calibration/curves/scaled_model.h"
#include "fem_reference/job.h"
#include "studies/run/job.h"

namespace fingertip::studies {

/// `order` at a Poisson's ratio, with its G and E = 2G(1 + nu), without fields. Depth, contact,
/// tilt, strain, law, mesh and tolerance are the order's. Throws InvalidInput, with the Poisson's
/// ratio in its value, for an order that is no static press or breaks a rule.
fem_reference::ReferenceJob at_ratio(const fem_reference::ReferenceJob& order,
                                     double poissons_ratio);

/// The lowest Poisson's ratio that the order's law takes.
double lowest_ratio(const fem_reference::ReferenceJob& order);

/// The model at the samples of the order. Its jobs are carried out by `context.run_all`, in
/// `place`/<Poisson's ratio>. `evaluate` throws InvalidInput for a response.csv that has other
/// samples than the order or forces that are not positive, and as the jobs do.
calibration::ScaledModel continuum_model(
    const fem_reference::ReferenceJob& order,
    const std::vector<calibration::MaterialParameter>& parameters, const std::string& place,
    const JobContext& context);

}  // namespace fingertip::studies
