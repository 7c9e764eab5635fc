/// What a laboratory does not know of its tests, beside the law: zeros, areas, what the law misses.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibration/material_tests/law_result.h"
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
/// ones. Behind the other parameters, starts and all; without `usual` those alone that are sought.
std::vector<ZeroPlaces> add_zeros(const std::vector<MaterialTest>& tests, bool usual,
                                  CurveFitOptions& options);

/// Of what least squares have found with `options` and the sought zeros, `fit.fit` and `fit.zeros`,
/// the posterior: usual zeros, a factor on each of several tests, a smooth part of each that the
/// law misses, and noise, all of sizes that the tests tell (posterior_fit). It gives intervals,
/// AICc and what is off in the tests; the estimates stay, for where a law misses much they are
/// those that meet the stresses best, as people expect. Of slow tests.
void add_posterior(const LawCurves& data, const CurveFitOptions& options, LawFit& fit);

/// The shear modulus at rest, after long times [Pa], with its 95 % interval.
struct ModulusOfLaws {
  double value = 0.0, lower = 0.0, upper = 0.0;
  std::vector<const LawFit*> laws;  ///< whose intervals it holds, of a ranking
};
/// Of one law: the posterior's interval, else by its coefficients' covariance.
ModulusOfLaws modulus_of(const LawFit& fit);

}  // namespace fingertip::calibration::inline material_tests
