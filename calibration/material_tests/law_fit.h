/// Laws of rubber from material tests: the fit, what it leaves open, how it compares with others.
#pragma once

#include <functional>
#include <vector>

#include "calibration/material_tests/law_posterior.h"
#include "calibration/material_tests/law_result.h"

namespace fingertip::calibration::inline material_tests {

/// Least squares over all tests together, with the intervals of a posterior where all are slow
/// (law_posterior.h). Slow tests count at their rate, those without one as
/// after long times. Throws InvalidInput for tests that break their rules, fewer points than
/// coefficients, some tests with sigma and some without, and where all tests are volumetric,
/// branches where all tests are slow; NotConverged where no start has an answer.
LawFit fit_law(const std::vector<MaterialTest>& tests, const LawChoice& choice,
               const LawFitOptions& options = {});

/// Of a test that the fit has not seen. A volumetric one needs fit.bulk_modulus (InvalidInput).
TestMisfit predict(const LawFit& fit, const MaterialTest& test,
                   TestWeights weights = TestWeights::test);

/// The laws, fitted to `tests` and asked for `validation`, the least AICc first, those without a
/// fit last. None fits worse than a law that is a case of it. `next` is told each law before its
/// fit, and the share of laws behind it; it may throw to stop. Throws as fit_law does where no law
/// can be fitted for the tests' sake.
std::vector<LawFit> rank_laws(const std::vector<MaterialTest>& tests,
                              const std::vector<MaterialTest>& validation,
                              const std::vector<LawChoice>& laws, const LawFitOptions& options = {},
                              const std::function<void(double, const LawChoice&)>& next = {});

/// Beyond it a prediction does not support a law, by rms_relative.
inline constexpr double supporting_error = 0.15;

/// Of a ranking the law to be used; null without any fit. Of those that passed their own tests the
/// first that predicts all tests held back within 15 % (rms_relative), or, where none does, the one
/// whose largest error, of fit or prediction, is least. Where nothing was held back and the tests
/// know one way of deforming alone, laws that meet them within 2 % of the stress of the best one
/// are equals, for so well do specimens repeat; of these the first that asks for little stress in
/// other ways of deforming, at most a tenth more than the one that asks for least. A case of
/// it that is as good (as_good_aicc, predictions within 2 %) goes before it. Where
/// no law passed its tests, the first that is stable, else the first.
const LawFit* recommended(const std::vector<LawFit>& ranking);

/// G at rest of the law `taken`; the interval is that of all stable laws of the ranking that are
/// supported as well as the best of them (as_good_aicc) and tell G within a factor of two, by
/// Akaike's weights, exp(-(AICc - the best)/2) (Burnham & Anderson, ch. 4): at rest they differ.
ModulusOfLaws modulus_of_laws(const std::vector<LawFit>& ranking, const LawFit& taken);

/// The laws that it chooses among; none where none passed its own tests.
std::vector<const LawFit*> equals(const std::vector<LawFit>& ranking);

}  // namespace fingertip::calibration::inline material_tests
