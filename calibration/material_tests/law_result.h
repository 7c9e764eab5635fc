/// What a fit of a law is asked for and what it yields.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "calibration/material_tests/law_model.h"
#include "calibration/material_tests/material_test.h"
#include "calibration/statistics/fit_result.h"
#include "calibration/statistics/residual_structure.h"
#include "meshes/press/press_response.h"
#include "meshes/rubber/relaxation.h"
#include "meshes/rubber/rubber.h"
#include "meshes/rubber/stability.h"

namespace fingertip::calibration::inline material_tests {

/// Laws so near to the least AICc are supported alike (Burnham & Anderson, Model selection and
/// multimodel inference, 2002, ch. 2: beyond 10 there is no support): of several that are tried
/// noise always prefers one that has a coefficient too many.
inline constexpr double as_good_aicc = 10.0;

/// What a residual is divided by. Where all tests have a sigma, that is it.
enum class TestWeights {
  test,    ///< the root mean square stress of its test: tests of other size count alike
  stress,  ///< the same for all: small stresses count little
  point,   ///< the stress itself, at least 5 % of its test's largest: relative errors
};
constexpr auto names_of(TestWeights) {
  using enum TestWeights;
  return meshes::names<TestWeights>({{test, "test"}, {stress, "stress"}, {point, "point"}});
}

struct LawFitOptions {
  TestWeights weights = TestWeights::test;
  unsigned seed = 1;  ///< of the exponents that searches for ogden begin with
  /// Principal stretches in which the law will be used, where they are known.
  std::optional<std::array<double, 2>> range_of_use;
};

/// How a law meets a test that it was fitted to, or predicts one.
struct TestMisfit {
  std::string name;  ///< of the test
  std::size_t points = 0;
  double rms = 0.0;               ///< of the residuals [Pa]
  double sum_of_squares = 0.0;    ///< of the residuals [Pa²]
  double rms_relative = 0.0;      ///< rms over the stresses' root mean square
  double largest_relative = 0.0;  ///< largest residual over the largest stress
  /// Share of the points within the 95 % interval of a further measurement, by the coefficients'
  /// covariance and the residuals' deviation; NaN without degrees of freedom. Residuals of one test
  /// hang together, and specimens differ: a share far below 0.95 says that they do.
  double within = 0.0;
  /// What the fit has found for a test's zeros: `stress` is that of the law at the deformations
  /// less the second, and adds to the first.
  double stress_zero = 0.0, strain_zero = 0.0;
  /// Of a test that was fitted: its stresses over those of the law, the tests' mean being 1, and
  /// the largest PartErrors::misfit; NaN where they are not sought.
  double factor = meshes::unknown, misfit = meshes::unknown;
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

/// What is off in a part of a test besides noise.
struct PartErrors {
  std::size_t test = 0;  ///< among those fitted
  TestPart part;
  double factor = 1.0;  ///< of its stresses on those of the law; of several parts
  /// Root mean square of what least squares leave, noise and a factor taken off, over that of it.
  double misfit = 0.0;
  bool misfit_seen = false;  ///< of all tests together by no chance
};

/// Zeros of a test that nobody told: of stress [Pa] and of strain, and what both make of the stress
/// at rest [Pa], with its standard error and deviation before any test. Both may be large and
/// cancel there, where a law is too simple.
struct UsualZeros {
  double stress = 0.0, strain = 0.0;
  double at_rest = 0.0, at_rest_error = 0.0, at_rest_usual = 0.0;
};

/// Where a test's zeros stand among a fit's parameters; none: they are zero.
struct ZeroPlaces {
  std::optional<Eigen::Index> stress, strain;
};

struct LawFit {
  LawChoice choice;
  /// Least squares over scaled stresses, without whitening and influence; coefficients, then
  /// bulk_modulus and zeros where they were sought. Of slow tests covariance and intervals are
  /// those of the posterior.
  CurveFit fit;
  SizedLaw law;
  meshes::Relaxation relaxation;       ///< the fastest branch first
  std::optional<double> bulk_modulus;  ///< [Pa]; none: no volumetric test
  /// -2 ln L + 2k + 2k(k + 1)/(n - k - 1), L the likelihood of n values, what the law misses
  /// smoothly, factors and zeros integrated out, k the coefficients, zeros that are sought, and a
  /// deviation (Hurvich & Tsai, Biometrika 76, 297, 1989), values being means of rows, at most 60
  /// of a test; an odd value costs its chance, one in 25. Of tests in time n ln(S/n) in place of -2
  /// ln L, S the weighted sum of squares, with sigma S. Infinite where n <= k + 1.
  double aicc = 0.0;
  std::array<double, 2> tested = {1.0, 1.0};  ///< principal stretches of the fitted tests
  /// Where the fitted tests tell how stress fades, from when to when [s] (observed_times).
  std::optional<std::array<double, 2>> times;
  /// Branches outside of those times, which the tests hardly know, and what would show them.
  std::vector<std::string> open_branches;
  std::vector<TestMisfit> fitted, predicted;
  std::vector<ZeroPlaces> zeros;  ///< per test fitted, where they were sought
  std::vector<UsualZeros> usual;  ///< per test fitted, where they were not; of slow tests
  /// The shear modulus at rest by the posterior and its 95 % interval [Pa]; of slow tests.
  std::optional<std::array<double, 3>> modulus;
  std::vector<PartErrors> parts;  ///< of the tests fitted that change the shape; of slow ones
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
  /// G at rest is not known within a factor of two, where it is unstable (Drucker), where it misses
  /// a test, or a side of one, by more than 15 % (rms, noise taken off), where tests contradict
  /// each other or do not go through rest by three times what is usual, and where a specimen was
  /// slack.
  std::vector<std::string> failed;
  /// Why there is no fit; all but `choice` is then empty.
  std::string failure;
};

}  // namespace fingertip::calibration::inline material_tests
