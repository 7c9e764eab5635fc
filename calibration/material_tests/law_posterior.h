/// What a laboratory does not know of its tests, beside the law: zeros, areas, what the law misses.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibration/material_tests/law_result.h"
#include "calibration/material_tests/zeroed_model.h"
#include "calibration/statistics/curve.h"
#include "calibration/statistics/fit_options.h"

namespace fingertip::calibration::inline material_tests {

/// Deviation of what nobody has told: a test's zero of stress over its largest stress and its zero
/// of strain over its largest strain, both with Cauchy's tails.
inline constexpr double usual_zero = 0.005;

/// Tests as curves over scales, one per point, with the models that answer for them.
struct LawCurves {
  std::vector<MaterialTest> tests;
  std::vector<std::vector<double>> scales;
  std::vector<Curve> curves;
};

/// Zeros that are sought, and zeros that are usual: of the stress of every test that changes the
/// shape, with the error of what was taken off where rows at rest told it; of the strain of slow
/// ones. Behind the other parameters, starts and all; `usual` leaves out the second kind.
std::vector<ZeroPlaces> add_zeros(const std::vector<MaterialTest>& tests, bool usual,
                                  CurveFitOptions& options);

/// In place of what the search for a law with `options` and the sought zeros has found, `fit.fit`
/// and `fit.zeros`, the posterior with usual zeros, a factor on each of several tests, a smooth
/// part of each that the law misses, and noise, all of sizes that the tests tell (posterior_fit).
/// Not of cycles.
void add_posterior(const LawCurves& data, const CurveFitOptions& options, LawFit& fit);

}  // namespace fingertip::calibration::inline material_tests
