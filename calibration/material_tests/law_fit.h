/// Laws of rubber from material tests: the fit, what it leaves open, how it compares with others.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "calibration/curves/curve_fit.h"
#include "calibration/curves/residual_structure.h"
#include "calibration/material_tests/law_model.h"
#include "calibration/material_tests/material_test.h"
#include "meshes/press_response.h"
#include "meshes/relaxation.h"
#include "meshes/rubber.h"

namespace fingertip::calibration {

/// What a residual is divided by. Where all tests have a sigma, that is it.
enum class TestWeights {
  test,    ///< the root mean square stress of its test: tests of other size count alike
  stress,  ///< the same for all: small stresses count little
  point,   ///< the stress itself, at least 5 % of its test's largest: relative errors
};
std::string_view name(TestWeights weights);
constexpr auto values(TestWeights) {
  return std::array{TestWeights::test, TestWeights::stress, TestWeights::point};
}

struct LawFitOptions {
  TestWeights weights = TestWeights::test;
  /// Searches for laws of more than one minimum (ogden, gent), from the best of `guesses` sets of
  /// exponents that are drawn between -25 and 25.
  int starts = 8;
  int guesses = 400;
  unsigned seed = 1;
  /// Principal stretches in which the law will be used, where they are known.
  std::optional<std::array<double, 2>> range_of_use;
};

/// How a law meets a test that it was fitted to, or predicts one.
struct TestMisfit {
  std::string test;
  std::size_t points = 0;
  double rms = 0.0;               ///< of the residuals [Pa]
  double sum_of_squares = 0.0;    ///< of the residuals [Pa²]
  double rms_relative = 0.0;      ///< rms over the stresses' root mean square
  double largest_relative = 0.0;  ///< largest residual over the largest stress
  /// Share of the points within the 95 % interval of a further measurement, by the coefficients'
  /// covariance and the residuals' deviation; NaN without degrees of freedom. Residuals of one test
  /// hang together, and specimens differ: a share far below 0.95 says that they do.
  double within = 0.0;
  bool in_range = true;        ///< the stretches are among those of the fitted tests
  std::vector<double> stress;  ///< of the law at the test's points [Pa]
  /// Of cycles: loop_area of the stresses measured and of the law's [J/m³]; else NaN.
  double loop_measured = meshes::unknown, loop_computed = meshes::unknown;
  ResidualStructure structure;
};

/// What a law says of a way of deforming that no test tells of.
struct UntestedMode {
  DeformationMode mode = DeformationMode::shear;
  double stretch = 1.0;  ///< of a tension, a compression or a planar tension
  double stress = 0.0;   ///< nominal, after long times [Pa]
  double share = 0.0;    ///< |stress| over that in the way tested, at the same largest stretch
};

struct LawFit {
  LawChoice choice;
  /// Over scaled stresses, without whitening and influence; coefficients, then bulk_modulus where
  /// it was sought.
  CurveFit fit;
  SizedLaw law;
  meshes::Relaxation relaxation;       ///< the fastest branch first
  std::optional<double> bulk_modulus;  ///< [Pa]; none: no volumetric test
  /// n ln(S/n) + 2k + 2k(k + 1)/(n - k - 1), n residuals of weighted sum of squares S, k the
  /// coefficients and, without sigma, the deviation (Hurvich & Tsai, Biometrika 76, 297, 1989);
  /// with sigma S + 2k + ... Infinite where n <= k + 1.
  double aicc = 0.0;
  std::array<double, 2> tested = {1.0, 1.0};  ///< principal stretches of the fitted tests
  /// Where the fitted tests tell how stress fades, from when to when [s] (observed_times).
  std::optional<std::array<double, 2>> times;
  /// Branches outside of those times, which the tests hardly know, and what would show them.
  std::vector<std::string> open_branches;
  std::vector<TestMisfit> fitted, predicted;
  /// Where the fitted tests know one way of deforming alone, the others, as far as that was
  /// strained and the law will be used.
  std::vector<UntestedMode> untested;
  /// Drucker's rule: within the stretches tested, used, and between 0.5 and 2, which presses ask.
  std::optional<meshes::Instability> unstable_in_tests, unstable_in_use, unstable_in_press;
  /// What contradicts it, in plain sentences: residuals of structure, predictions that miss,
  /// coefficients that are open or at a bound, instabilities. Empty: nothing seen.
  std::vector<std::string> contradictions;
  /// Those of them for which it must not be used as it is; none: it passed its own tests. It fails
  /// where the search did not end, a coefficient ended at a bound, a direction or a branch is open,
  /// where it is unstable (Drucker), and where it misses a test, or a side of one, by more than
  /// 15 % (relative_rms) that no sigma explains.
  std::vector<std::string> failed;
  /// Why there is no fit; all but `choice` is then empty.
  std::string failure;
};

/// Least squares over all tests together. Slow tests count at their rate, those without one as
/// after long times. Throws InvalidInput for tests that break their rules, fewer points than
/// coefficients, some tests with sigma and some without, and where all tests are volumetric,
/// branches where all tests are slow; NotConverged where no start has an answer.
LawFit fit_law(const std::vector<MaterialTest>& tests, const LawChoice& choice,
               const LawFitOptions& options = {});

/// Of a test that the fit has not seen. A volumetric one needs fit.bulk_modulus (InvalidInput).
TestMisfit predict(const LawFit& fit, const MaterialTest& test,
                   TestWeights weights = TestWeights::test);

/// The laws, fitted to `tests` and asked for `held_back`, the least AICc first, those without a fit
/// last. None fits worse than a law that is a case of it. `next` is told each law before its fit,
/// and the share of laws behind it; it may throw to stop. Throws as fit_law does where no law can
/// be fitted for the tests' sake.
std::vector<LawFit> rank_laws(const std::vector<MaterialTest>& tests,
                              const std::vector<MaterialTest>& held_back,
                              const std::vector<LawChoice>& laws, const LawFitOptions& options = {},
                              const std::function<void(double, const LawChoice&)>& next = {});

/// Beyond it a prediction does not support a law, by rms_relative.
inline constexpr double supporting_error = 0.15;

/// Laws so near to the least AICc are supported alike (Burnham & Anderson, Model selection and
/// multimodel inference, 2002, ch. 2: beyond 10 there is no support): of several that are tried
/// noise always prefers one that has a coefficient too many.
inline constexpr double as_good_aicc = 10.0;

/// Of a ranking the law to be used; null without any fit. Of those that passed their own tests the
/// first that predicts all tests held back within 15 % (rms_relative), or, where none does, the one
/// whose largest error, of fit or prediction, is least. Where nothing was held back and the tests
/// know one way of deforming alone, laws that meet them within 2 % of the stress of the best one
/// are equals, for so well do specimens repeat; of these the first that asks for little stress in
/// other ways of deforming, at most a tenth more than the one that asks for least. A case of
/// it that is as good (as_good_aicc, predictions within 2 %) goes before it. Where
/// no law passed its tests, the first that is stable, else the first.
const LawFit* recommended(const std::vector<LawFit>& ranking);

/// The laws that it chooses among; none where none passed its own tests.
std::vector<const LawFit*> equals(const std::vector<LawFit>& ranking);

/// E, G, the energy and the relaxation of a fit as a rubber; nu is that of `bulk_modulus`, or
/// `poissons_ratio` where it is unknown. Its rules may be broken: Rubber::violations tells.
meshes::Rubber rubber_of(const LawFit& fit, double poissons_ratio);

}  // namespace fingertip::calibration
