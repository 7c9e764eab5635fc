#include "calibration/material_tests/law_zeros.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "calibration/files/words.h"
#include "calibration/material_tests/law_contradictions.h"
#include "calibration/material_tests/law_fit.h"
#include "calibration/material_tests/zeroed_model.h"
#include "calibration/statistics/fit_statistics.h"
#include "meshes/base/errors.h"

namespace fingertip::calibration::inline material_tests {

using Eigen::Index;
using Eigen::VectorXd;

std::optional<StressAtRest> stress_at_rest(const MaterialTest& test) {
  constexpr double low_share = 1.0 / 3.0;
  constexpr std::size_t least = 6;
  if (test.kind == TestKind::volumetric || test.course != TestCourse::slow) return {};
  const double rest = rest_of(test.kind), most = low_share * reach_of(test);
  std::vector<std::size_t> low;
  for (std::size_t i = 0; i < test.deformation.size(); ++i)
    if (std::abs(test.deformation[i] - rest) <= most) low.push_back(i);
  if (low.size() < least) return {};
  const Index rows = Index(low.size());
  Eigen::MatrixXd columns(rows, 3);
  VectorXd stress(rows);
  for (Index k = 0; k < rows; ++k) {
    const std::size_t i = low[std::size_t(k)];
    const double unit = test_stress({1.0, {}}, test.kind, test.measure, test.deformation[i]) *
                        (test.constraint.empty() ? 1.0 : test.constraint[i]);
    columns.row(k) << 1.0, unit, unit * unit;
    stress(k) = test.stress[i];
  }
  const VectorXd found = columns.colPivHouseholderQr().solve(stress);
  const double variance =
      (stress - columns * found).squaredNorm() / std::max(1.0, double(rows) - 3.0);
  const Eigen::MatrixXd inverse =
      (columns.transpose() * columns).completeOrthogonalDecomposition().pseudoInverse();
  return StressAtRest{found(0), std::sqrt(variance * inverse(0, 0))};
}

namespace {

/// Laws of a ranking that are tried with zeros: those of least AICc, and the simplest.
std::vector<LawChoice> to_be_tried(const std::vector<LawFit>& ranking) {
  constexpr std::size_t most = 3;
  std::vector<LawChoice> laws;
  const auto add = [&](const LawFit& fit) {
    if (fit.failure.empty() && std::ranges::find(laws, fit.choice) == laws.end())
      laws.push_back(fit.choice);
  };
  for (const LawFit& fit : ranking)
    if (laws.size() < most) add(fit);
  const auto coefficients_of = [](const LawFit& fit) {
    return fit.failure.empty() ? fit.fit.estimates.size() : Index(1000);
  };
  if (!ranking.empty()) add(*std::ranges::min_element(ranking, {}, coefficients_of));
  return laws;
}

/// Where the stress vanishes by a line through the rows of least stress, a third of the largest and
/// below; none where so few rows tell no line.
std::optional<double> where_stress_vanishes(const MaterialTest& test) {
  constexpr double low_share = 1.0 / 3.0;
  const double most = low_share * largest_stress(test);
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t i = 0; i < test.stress.size(); ++i) {
    const double x = test.deformation[i] - rest_of(test.kind), y = test.stress[i];
    if (std::abs(y) > most) continue;
    n += 1.0, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const double determinant = n * sxx - sx * sx, slope = (n * sxy - sx * sy) / determinant;
  if (n < 3.0 || !(determinant > 0.0) || slope == 0.0) return {};
  return sx / n - sy / n / slope;
}

bool is_sought(const MaterialTest& test, MaterialParameter zero) {
  return zero == MaterialParameter::stress_zero ? test.stress_zero_sought : test.strain_zero_sought;
}

/// Whether nothing tells a test's zero, of stress or of strain.
bool may_be_free(const MaterialTest& test, MaterialParameter zero) {
  return test.kind != TestKind::volumetric &&
         (zero == MaterialParameter::stress_zero ? !test.stress_zero_known
                                                 : test.course == TestCourse::slow);
}

/// The best of a few laws where every test's zero, of stress or of strain, is free unless known.
/// What a free zero of stress makes of G goes into the ranking.
std::optional<LawFit> best_with_zeros(const std::vector<MaterialTest>& tests,
                                      MaterialParameter zero, std::vector<LawFit>& ranking,
                                      const LawFitOptions& options) {
  std::vector<MaterialTest> free = tests;
  bool some = false;
  for (MaterialTest& test : free) {
    if (!may_be_free(test, zero)) continue;
    some = true;
    (zero == MaterialParameter::stress_zero ? test.stress_zero_sought : test.strain_zero_sought) =
        true;
  }
  std::optional<LawFit> best;
  if (!some) return best;
  for (const LawChoice& law : to_be_tried(ranking)) {
    try {
      LawFit fit = fit_law(free, law, options);
      if (zero == MaterialParameter::stress_zero) {
        const ModulusOfLaws modulus = modulus_of(fit);
        std::ranges::find(ranking, law, &LawFit::choice)->with_free_zero = {fit.aicc, modulus.lower,
                                                                            modulus.upper};
      }
      if (!best || fit.aicc < best->aicc) best = std::move(fit);
    } catch (const std::exception&) {  // too few points for so many, or no answer
    }
  }
  return best;
}

/// What a zero of a test means for it; "": nothing, for the rows speak against it.
std::string sentence_of(const MaterialTest& test, MaterialParameter which, double zero,
                        double error, const LawFit& with, const LawFit& without) {
  constexpr double matters = 0.01, far = 0.05;  // of the largest stress; of the largest strain
  const std::string moduli = ", and for G = " + rounded(with.law.shear_modulus, 3) +
                             " Pa in place of " + rounded(without.law.shear_modulus, 3) + " Pa. ";
  const std::string begin = test.name + " does not go through rest: with a free zero of its ";
  if (which == MaterialParameter::strain_zero) {
    const auto vanishes = where_stress_vanishes(test);
    if (!vanishes || std::abs(zero) < far * reach_of(test) ||
        std::abs(*vanishes - zero) > 0.5 * std::abs(zero))
      return "";
    return begin + "strain the laws ask for a stress that vanishes at the deformation " +
           rounded(rest_of(test.kind) + zero, 4) + " and not at " + rounded(rest_of(test.kind), 1) +
           moduli +
           "An unloading of a specimen that has kept a set, slack, or a wrong zero of the strain: "
           "give the loading from rest on, or write zero = \"fit\" in its strain";
  }
  const double most = largest_stress(test);
  const auto seen = stress_at_rest(test);
  if (std::abs(zero) < matters * most) return "";
  // Rows near rest that go through it: the law is too simple.
  if (seen && std::abs(seen->value - zero) > 3.0 * seen->error + 0.25 * std::abs(zero)) return "";
  return begin + "stress the laws ask for " + rounded(zero, 3) + " Pa there, within " +
         rounded(normal_95() * error, 2) + " Pa, " + percent(std::abs(zero) / most) +
         " of the largest" + moduli +
         "The load cell's zero, or a set or slack of the specimen: write zero = \"fit\" in its "
         "stress, or in its strain, or give rows at rest";
}

/// Of a test whose rows begin away from rest and bear next to nothing there, a fifth of what a
/// straight curve would: why it is no loading from rest; "": it may be.
std::string begins_without_stress(const MaterialTest& test) {
  constexpr double far = 0.05, least = 0.2;
  constexpr std::size_t few = 3;
  const bool tells = test.course == TestCourse::slow && test.kind != TestKind::volumetric &&
                     !test.strain_zero_sought && test.stress.size() > few;
  if (!tells) return "";
  const double rest = rest_of(test.kind), reach = reach_of(test);
  const auto away = [&](std::size_t i) { return std::abs(test.deformation[i] - rest) / reach; };
  std::vector<std::size_t> nearest(test.stress.size());
  std::iota(nearest.begin(), nearest.end(), 0U);
  std::ranges::sort(nearest, {}, away);
  double stress = 0.0, strain = 0.0;
  for (std::size_t i = 0; i < few; ++i)
    stress += test.stress[nearest[i]] / few, strain += away(nearest[i]) / few;
  if (away(nearest[0]) < far || std::abs(stress) > least * strain * largest_stress(test)) return "";
  return test.name + " does not go through rest: its rows begin at the deformation " +
         rounded(test.deformation[nearest[0]], 4) + ", where its stress vanishes, and not at " +
         rounded(rest, 1) +
         ". An unloading of a specimen that has kept a set, slack, or a wrong zero of the strain: "
         "give the loading from rest on, or write zero = \"fit\" in its strain";
}

/// A sentence each.
std::vector<std::string> zeros_that_show(const std::vector<MaterialTest>& tests,
                                         std::vector<LawFit>& ranking,
                                         const LawFitOptions& options) {
  constexpr double far_from_zero = 4.0;  // standard errors
  if (ranking.empty() || !ranking.front().failure.empty()) return {};
  std::vector<std::string> sentences;
  for (const MaterialTest& test : tests)
    if (const std::string sentence = begins_without_stress(test); !sentence.empty())
      sentences.push_back(sentence);
  if (!sentences.empty()) return sentences;
  double least = ranking.front().aicc - as_good_aicc;
  for (const MaterialParameter which :
       {MaterialParameter::stress_zero, MaterialParameter::strain_zero}) {
    const auto best = best_with_zeros(tests, which, ranking, options);
    if (!best || !(best->aicc < least)) continue;
    std::vector<std::string> told;
    // Zeros stand in the order of their tests, which may share a name.
    auto parameter = best->fit.parameters.begin();
    for (const MaterialTest& test : tests) {
      if (!may_be_free(test, which) && !is_sought(test, which)) continue;
      parameter = std::find(parameter, best->fit.parameters.end(), which);
      const Index i = parameter++ - best->fit.parameters.begin();
      const double zero = best->fit.estimates(i), error = best->fit.standard_errors(i);
      if (is_sought(test, which) || !(std::abs(zero) > far_from_zero * error)) continue;
      const std::string sentence =
          sentence_of(test, which, zero, error, *best, *recommended(ranking));
      if (!sentence.empty()) told.push_back(sentence);
    }
    // The second alternative where it explains more.
    if (told.empty()) continue;
    sentences = std::move(told);
    least = best->aicc - as_good_aicc;
  }
  return sentences;
}

}  // namespace

void add_zeros_that_show(const std::vector<MaterialTest>& tests, std::vector<LawFit>& ranking,
                         const LawFitOptions& options) {
  for (const std::string& sentence : zeros_that_show(tests, ranking, options))
    for (LawFit& fit : ranking)
      if (fit.failure.empty()) fail(fit, sentence);
}

}  // namespace fingertip::calibration::inline material_tests
