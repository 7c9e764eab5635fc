#include "calibration/material_tests/law_contradictions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "calibration/files/words.h"
#include "calibration/material/relaxation_branches.h"
#include "calibration/statistics/curve_checks.h"
#include "meshes/rubber/plausible.h"

namespace fingertip::calibration::inline material_tests {

using Eigen::Index;

namespace {

/// Two coefficients of a higher correlation are one to the tests.
constexpr double collinear = 0.995;
/// Residuals of so unlikely an order show something that the law misses.
constexpr double unlikely_order = 0.05;
/// A test missed by more than this share, by relative_rms, is not described: specimens, batches and
/// machines let tests of one rubber differ by some 10 %, and a law is no more than a law.
constexpr double largest_misfit_of_law = 0.15;
/// What a test does on one side of rest counts by itself where it goes so far, of all its strain.
constexpr double min_side = 0.1;
/// Up to this logarithmic strain rubbers are neo-Hookean enough for a modulus [1], and moduli that
/// differ by more than this factor contradict each other.
constexpr double small_strain = 0.3, contradiction = 1.3;
/// Likewise tests of one way of deforming.
constexpr double scatter = 1.15;
/// A specimen was slack where it bore less than this share of what a taut one would, and its
/// curve asks for a later origin by so many standard errors.
constexpr double bears_nothing = 0.2, surely = 5.0;
/// Stretches that presses ask for, and StrainEnergy's own rule.
constexpr std::array<double, 2> press_range = {0.5, 2.0};
/// A prediction that misses by more contradicts the law.
constexpr double miss = 0.1;

std::string instability_text(const meshes::Instability& at, const char* where) {
  return "the law is unstable (Drucker) from the stretch " + rounded(at.stretch) + " on in " +
         std::string(name(at.test)) + " tests, which is " + where;
}

std::string size_text(double share) {
  return rounded(100.0 * share, 3) + " %";
}

void add_open_coefficients(LawFit& result) {
  const CurveFit& fit = result.fit;
  auto& told = result.contradictions;
  if (!fit.converged) fail(result, "the search ended before its minimum");
  for (std::size_t i = 0; i < fit.parameters.size(); ++i)
    if (fit.at_bound[i])
      fail(result, std::string(name(fit.parameters[i])) +
                       " ended at its bound: the tests ask for another law, or for fewer terms");
  for (const Direction& direction : fit.unidentifiable) fail(result, direction.statement);
  for (Index i = 0; i < fit.correlation.rows(); ++i)
    for (Index j = 0; j < i; ++j)
      if (std::abs(fit.correlation(i, j)) > collinear)
        told.push_back("the tests hardly tell " +
                       std::string(name(fit.parameters[std::size_t(j)])) + " and " +
                       std::string(name(fit.parameters[std::size_t(i)])) +
                       " apart: their correlation is " + rounded(fit.correlation(i, j), 5));
}

void add_instabilities(LawFit& result, const LawFitOptions& options) {
  const auto within = [&](const std::array<double, 2>& range) {
    // The search begins at rest.
    return first_instability(result.law.energy, std::min(range[0], 0.999),
                             std::max(range[1], 1.001));
  };
  result.unstable_in_tests = within(result.tested);
  result.unstable_in_press = within(press_range);
  if (options.range_of_use) result.unstable_in_use = within(*options.range_of_use);
  if (result.unstable_in_tests)
    fail(result,
         instability_text(*result.unstable_in_tests, "within the stretches of the fitted tests"));
  else if (result.unstable_in_use)
    fail(result, instability_text(*result.unstable_in_use, "within the stretches of use"));
  else if (result.unstable_in_press)
    fail(result,
         instability_text(*result.unstable_in_press, "within 0.5 to 2, which a press asks for"));
}

/// Largest logarithmic strain [1].
double strain_size(TestKind kind, double deformation) {
  double size = 0.0;
  for (const double stretch : principal_stretches(kind, deformation))
    size = std::max(size, std::abs(std::log(stretch)));
  return size;
}

/// Points of a test that deform the rubber in one way.
struct TestPart {
  std::string name, way;  ///< of the test, and its side where it has both; "biaxial tension"
  DeformationMode mode = DeformationMode::shear;
  std::vector<std::size_t> points;
  double strain = 0.0;  ///< the largest
};

std::string way_of(TestKind kind, DeformationMode mode) {
  if (kind == TestKind::planar) return "planar tension";
  if (kind != TestKind::equibiaxial) return std::string(name(mode));
  return mode == DeformationMode::compression ? "biaxial tension" : "biaxial compression";
}

std::vector<TestPart> parts_of(const MaterialTest& test) {
  std::map<DeformationMode, TestPart> sides;
  for (std::size_t i = 0; i < test.deformation.size(); ++i) {
    const DeformationMode mode = mode_of(test.kind, test.deformation[i]);
    TestPart& side = sides[mode];
    side.mode = mode;
    side.way = way_of(test.kind, mode);
    side.name = test.name + " in " + side.way;
    side.points.push_back(i);
    side.strain = std::max(side.strain, strain_size(test.kind, test.deformation[i]));
  }
  std::vector<TestPart> parts;
  for (auto& [mode, side] : sides) parts.push_back(std::move(side));
  std::ranges::stable_sort(parts, std::greater(), &TestPart::strain);
  if (parts.size() == 2 && parts[1].strain < min_side * parts[0].strain) {
    parts[0].points.insert(parts[0].points.end(), parts[1].points.begin(), parts[1].points.end());
    parts.pop_back();
  }
  if (parts.size() == 1) parts[0].name = test.name;
  return parts;
}

/// Least squares of a factor on `unit` against `stress`.
struct OneModulus {
  OneModulus(const Eigen::VectorXd& unit, const Eigen::VectorXd& stress)
      : modulus(unit.squaredNorm() > 0.0 ? unit.dot(stress) / unit.squaredNorm() : 0.0),
        left((stress - modulus * unit).squaredNorm()) {}
  double modulus, left;
};

/// Of many values from 0 to `most` the one that leaves least.
double best_value(double most, const std::function<double(double)>& left) {
  constexpr int values = 200;
  double best = 0.0, least = left(0.0);
  for (int i = 1; i <= values; ++i) {
    const double at = most * i / values, now = left(at);
    if (now < least) best = at, least = now;
  }
  return best;
}

/// The strain up to which a specimen was slack, or its plates did not touch: there it bears
/// nothing, and from there on it is a rubber whose strain counts from that origin. A rubber's
/// secant modulus, by neo-Hooke, is constant at small strain, or falls. Tissues, and rubbers near
/// their limit, stiffen from the first strain on, G exp(b strain^p), p = 1 or 2 (Fung 1967; Demiray
/// 1972), or by a parabola that ends in a straight line (tendons), which no curve does that is flat
/// and then straight (AIC differs by as_good_aicc at least).
std::optional<double> slack_of(const MaterialTest& test, const TestPart& part) {
  const double rest = rest_of(test.kind), common = 1.001 * std::min(small_strain, part.strain);
  std::vector<std::size_t> small = part.points;
  std::erase_if(
      small, [&](std::size_t i) { return strain_size(test.kind, test.deformation[i]) > common; });
  if (small.size() < 5) return std::nullopt;
  Eigen::ArrayXd strain(Index(small.size())), size = strain;
  Eigen::VectorXd stress = strain;
  for (Index k = 0; k < strain.size(); ++k) {
    const std::size_t i = small[std::size_t(k)];
    strain(k) = test.deformation[i] - rest;
    size(k) = strain_size(test.kind, test.deformation[i]) / common;
    stress(k) = test.stress[i] / (test.constraint.empty() ? 1.0 : test.constraint[i]);
  }
  const auto from = [&](double origin) -> Eigen::VectorXd {
    return strain.unaryExpr([&](double e) {
      const double taut = std::copysign(std::max(0.0, std::abs(e) - origin), e);
      return test_stress({1.0, {}}, test.kind, test.measure, rest + taut);
    });
  };
  const Eigen::ArrayXd whole = from(0.0);
  double stiffened = OneModulus(whole, stress).left;
  const double at_rest = stiffened;
  const auto stiffening = [&](double most, const auto& factor) {
    const auto left = [&](double b) { return OneModulus(whole * factor(b), stress).left; };
    stiffened = std::min(stiffened, left(best_value(most, left)));
  };
  for (const int power : {1, 2})
    stiffening(20.0, [&](double b) { return Eigen::ArrayXd((b * size.pow(power)).exp()); });
  stiffening(1.0, [&](double toe) {
    return Eigen::ArrayXd((size < toe).select(size / (2.0 * toe), 1.0 - toe / (2.0 * size)));
  });
  const double origin = best_value(0.5 * strain.abs().maxCoeff(),
                                   [&](double at) { return OneModulus(from(at), stress).left; });
  const OneModulus later(from(origin), stress);
  const Eigen::ArrayXd before = (strain.abs() < origin).cast<double>();
  const double borne = std::abs((before * stress.array()).sum()),
               asked = later.modulus * std::abs((before * whole).sum()),
               variance = later.left / double(strain.size() - 2);
  const bool slack = before.sum() >= 2.0 && borne < bears_nothing * asked &&
                     at_rest - later.left > surely * surely * variance &&
                     later.left < std::exp(-as_good_aicc / double(strain.size())) * stiffened;
  return slack ? std::optional(origin) : std::nullopt;
}

void add_slack(LawFit& result, const std::vector<MaterialTest>& tests) {
  for (const MaterialTest& test : tests) {
    if (test.kind == TestKind::volumetric || test.course != TestCourse::slow) continue;
    for (const TestPart& part : parts_of(test))
      if (const auto strain = slack_of(test, part))
        fail(result, part.name + " was slack, or not yet touched by its plates, up to the strain " +
                         rounded(*strain, 2) +
                         ": no stress there, and beyond it that of a rubber strained from there. "
                         "Leave those rows out and measure lengths and strains from there on");
  }
}

/// The modulus of small strain, by neo-Hooke, that points of tests ask for.
class SmallStrainModulus {
 public:
  void add(const MaterialTest& test, std::size_t point) {
    const double unit = (test.constraint.empty() ? 1.0 : test.constraint[point]) *
                        test_stress({1.0, {}}, test.kind, test.measure, test.deformation[point]);
    product_ += unit * test.stress[point];
    square_ += unit * unit;
  }
  bool known() const { return square_ > 0.0; }
  double value() const { return product_ / square_; }

 private:
  double product_ = 0.0, square_ = 0.0;
};

/// "a and b contradict": names and moduli of these, joined.
struct Joined {
  std::string names, moduli;
};
Joined joined(const std::map<std::string, SmallStrainModulus>& moduli) {
  Joined text;
  for (auto each = moduli.begin(); each != moduli.end(); ++each) {
    const char* link = each == moduli.begin()            ? ""
                       : std::next(each) == moduli.end() ? " and "
                                                         : ", ";
    text.names += link + each->first;
    text.moduli += link + rounded(each->second.value(), 3) + " Pa in " + each->first;
  }
  return text;
}

/// Largest over least.
double ratio_of(const std::map<std::string, SmallStrainModulus>& moduli) {
  const auto [least, most] =
      std::ranges::minmax_element(moduli, {}, [](const auto& each) { return each.second.value(); });
  return most->second.value() / least->second.value();
}

/// Of tests that differ: whether the modulus grows with their rates, and by how many times these
/// differ; 1: no.
double growth_with_rate(const std::vector<MaterialTest>& tests,
                        const std::map<std::string, SmallStrainModulus>& moduli) {
  std::vector<std::pair<double, double>> known;
  for (const MaterialTest& test : tests)
    if (const auto found = moduli.find(test.name); found != moduli.end() && test.rate)
      known.emplace_back(*test.rate, found->second.value());
  std::ranges::sort(known);
  const bool grows = known.size() == moduli.size() && known.size() > 1 &&
                     std::ranges::is_sorted(known, {}, &std::pair<double, double>::second);
  return grows ? known.back().first / known.front().first : 1.0;
}

std::string specimens_sentence(const std::vector<MaterialTest>& tests, const std::string& way,
                               const std::map<std::string, SmallStrainModulus>& moduli,
                               double strain) {
  constexpr double other_rate = 3.0;
  const Joined text = joined(moduli);
  const double rates = growth_with_rate(tests, moduli);
  const std::string differ = "tests in " + way + " differ: up to the logarithmic strain " +
                             rounded(strain, 2) + " they ask for G = " + text.moduli + ". ";
  if (rates > other_rate)
    return differ + "Their rates differ " + rounded(rates, 2) +
           " times, and G grows with them, so that the rubber likely relaxes: fit tests of one "
           "rate, or tests in time (kind = \"relaxation\" or \"cycles\") with a law +prony";
  return differ +
         "Specimens that scatter are one test: path = [...] of all of them, whose mean is fitted "
         "and whose scatter the intervals have. Else look at areas, lengths and batches";
}

/// Where moduli of small strain, by neo-Hooke, differ between tests of one way of deforming, and
/// with the way.
struct ModuliThatDiffer {
  std::vector<std::string> specimens, ways;
};
ModuliThatDiffer moduli_that_differ(const std::vector<MaterialTest>& tests) {
  const auto tells = [](const MaterialTest& test) {
    return test.kind != TestKind::volumetric && test.course == TestCourse::slow;
  };
  double common = small_strain;
  for (const MaterialTest& test : tests)
    for (const TestPart& part : parts_of(test))
      if (tells(test)) common = std::min(common, part.strain);
  std::map<std::string, SmallStrainModulus> ways;
  std::map<std::string, std::map<std::string, SmallStrainModulus>> specimens;
  for (const MaterialTest& test : tests)
    for (const TestPart& part : parts_of(test))
      for (const std::size_t i : part.points) {
        if (!tells(test) || strain_size(test.kind, test.deformation[i]) > 1.001 * common) continue;
        ways[part.way].add(test, i);
        specimens[part.way][test.name].add(test, i);
      }
  const auto unknown = [](const auto& each) { return !each.second.known(); };
  ModuliThatDiffer found;
  for (auto& [way, moduli] : specimens) {
    std::erase_if(moduli, unknown);
    if (moduli.size() > 1 && ratio_of(moduli) > scatter)
      found.specimens.push_back(specimens_sentence(tests, way, moduli, common));
  }
  std::erase_if(ways, unknown);
  if (ways.size() < 2 || ratio_of(ways) <= contradiction) return found;
  const Joined text = joined(ways);
  found.ways.push_back(text.names + " contradict each other: up to the logarithmic strain " +
                       rounded(common, 2) + " they ask for G = " + text.moduli +
                       ", and a rubber that keeps its volume has one. Is it compressible (a foam)? "
                       "Else look at areas, slack, plates that stick, and specimens of another "
                       "batch");
  return found;
}

void add_misfits(LawFit& result, const std::vector<MaterialTest>& tests) {
  for (const TestMisfit& misfit : result.fitted)
    if (misfit.structure.probability < unlikely_order)
      result.contradictions.push_back("residuals of " + misfit.name + " (rms " +
                                      size_text(misfit.rms_relative) +
                                      "): " + misfit.structure.statement);
  if (result.fit.chi_square_probability && result.fit.birge_ratio == 1.0) return;
  // Why a test is missed comes behind.
  const std::size_t failed = result.failed.size();
  for (std::size_t t = 0; t < tests.size(); ++t)
    for (const TestPart& part : parts_of(tests[t])) {
      Eigen::VectorXd measured(Index(part.points.size())), residuals = measured;
      for (Index i = 0; i < measured.size(); ++i) {
        const std::size_t p = part.points[std::size_t(i)];
        measured(i) = tests[t].stress[p];
        residuals(i) = measured(i) - result.fitted[t].stress[p];
      }
      if (const auto sentence =
              missed("the law", part.name, residuals, measured, largest_misfit_of_law))
        fail(result, *sentence);
    }
  const ModuliThatDiffer moduli = moduli_that_differ(tests);
  if (result.choice.branches == 0)
    for (const std::string& sentence : moduli.specimens) fail(result, sentence);
  if (result.failed.size() == failed) return;
  for (const std::string& sentence : moduli.ways) fail(result, sentence);
}

}  // namespace

void fail(LawFit& result, const std::string& sentence) {
  result.contradictions.push_back(sentence);
  result.failed.push_back(sentence);
}

void add_contradictions(LawFit& result, const std::vector<MaterialTest>& tests,
                        const LawFitOptions& options) {
  add_instabilities(result, options);
  add_open_coefficients(result);
  if (result.times) result.open_branches = open_branches(result.relaxation, *result.times);
  for (const std::string& sentence : result.open_branches) fail(result, sentence);
  for (const MaterialTest& test : tests)
    for (const std::string& doubt : test.doubts) fail(result, doubt);
  // Of a rubber that keeps its volume.
  const std::string modulus = meshes::implausible_modulus(3.0 * result.law.shear_modulus);
  if (!modulus.empty()) fail(result, modulus);
  add_slack(result, tests);
  add_misfits(result, tests);
}

std::vector<UntestedMode> untested_modes(const LawFit& fit, const std::vector<MaterialTest>& tests,
                                         const LawFitOptions& options) {
  std::set<DeformationMode> known;
  for (const MaterialTest& test : tests)
    if (test.kind != TestKind::volumetric)
      for (const TestPart& part : parts_of(test)) known.insert(part.mode);
  if (known.size() != 1) return {};
  const auto strain = [](const std::array<double, 2>& range) {
    return std::max(-std::log(range[0]), std::log(range[1]));
  };
  const double reach =
      std::min(strain(fit.tested), strain(options.range_of_use.value_or(press_range)));
  const auto told = [&](DeformationMode mode) {
    const double stretch = std::exp(mode == DeformationMode::compression ? -reach : reach);
    const TestKind kind = mode == DeformationMode::shear ? TestKind::planar : TestKind::uniaxial;
    return UntestedMode{mode, stretch, test_stress(fit.law, kind, StressMeasure::nominal, stretch)};
  };
  std::vector<UntestedMode> modes;
  for (const DeformationMode mode : values(DeformationMode()))
    if (!known.contains(mode)) modes.push_back(told(mode));
  for (UntestedMode& mode : modes) mode.share = std::abs(mode.stress / told(*known.begin()).stress);
  return modes;
}

void add_differences(const std::vector<const LawFit*>& laws, std::vector<LawFit>& ranking) {
  if (laws.empty() || laws.front()->untested.empty() || !laws.front()->predicted.empty()) return;
  std::string text;
  for (std::size_t i = 0; i < laws.front()->untested.size(); ++i) {
    const auto stress = [&](const LawFit* law) { return std::abs(law->untested[i].stress); };
    const auto [least, most] = std::ranges::minmax(laws, {}, stress);
    const UntestedMode& mode = least->untested[i];
    text += std::string(i == 0 ? "in " : "; in ") + std::string(name(mode.mode)) +
            " to the stretch " + rounded(mode.stretch, 3) + " from " + rounded(stress(least), 3) +
            " Pa (" + name(least->choice) + ") to " + rounded(stress(most), 3) + " Pa (" +
            name(most->choice) + ")";
  }
  for (LawFit& fit : ranking)
    if (std::ranges::find(laws, &fit) != laws.end() && laws.size() > 1)
      fit.contradictions.push_back("the tests deform the rubber in one way alone, and " +
                                   std::to_string(laws.size()) +
                                   " laws that meet them alike differ in others: " + text);
}

void add_missed_predictions(LawFit& result) {
  for (const TestMisfit& misfit : result.predicted) {
    if (misfit.largest_relative <= miss && misfit.rms_relative <= miss) continue;
    result.contradictions.push_back(
        misfit.name + ", which was not fitted, is missed by " + size_text(misfit.rms_relative) +
        " (rms), " + size_text(misfit.largest_relative) + " at most" +
        (misfit.in_range ? "" : "; its stretches go beyond those of the fitted tests"));
  }
  for (const std::vector<TestMisfit>* list : {&result.fitted, &result.predicted})
    for (const TestMisfit& misfit : *list) {
      const double measured = misfit.loop_measured, computed = misfit.loop_computed;
      if (!(std::abs(computed - measured) > miss * std::abs(measured))) continue;
      result.contradictions.push_back("the loops of " + misfit.name + " hold " +
                                      rounded(measured, 3) + " J/m^3, those of the law " +
                                      rounded(computed, 3));
    }
}

}  // namespace fingertip::calibration::inline material_tests
