#include "calibration/material_tests/law_contradictions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "calibration/files/words.h"
#include "calibration/material/relaxation_branches.h"
#include "calibration/material_tests/law_posterior.h"
#include "calibration/material_tests/zeroed_model.h"
#include "calibration/statistics/curve_checks.h"
#include "calibration/statistics/fit_statistics.h"
#include "meshes/rubber/plausible.h"

namespace fingertip::calibration::inline material_tests {

using Eigen::Index;

namespace {

/// Two coefficients of a higher correlation are one to the tests.
constexpr double collinear = 0.99;
/// A test missed by more than this share of its stresses (rms) is not described, a law being no
/// more than a law; of cycles with noise and all. A smaller one is not worth a word.
constexpr double largest_misfit = 0.15, little_misfit = 0.003;
/// Stresses of two tests of one rubber, whose areas and batches differ, are no further apart than
/// by this factor: 3.5 deviations of two that are known to 3 %.
constexpr double largest_ratio = 1.15;
/// Beyond its largest stress that of a rubber does not fall, by this share.
constexpr double fall = 0.05;
/// Up to this logarithmic strain rubbers are neo-Hookean enough for a modulus [1].
constexpr double small_strain = 0.3;
/// A specimen was slack where it bore less than this share of what a taut one would, and its
/// curve asks for a later origin by so many standard errors.
constexpr double bears_nothing = 0.2, surely = 5.0;
/// Stretches that presses ask for, and StrainEnergy's own rule.
constexpr std::array<double, 2> press_range = {0.5, 2.0};
/// A prediction that misses by more contradicts the law.
constexpr double miss = 0.1;

/// A sentence that forbids to use the law.
void fail(LawFit& result, const std::string& sentence) {
  result.contradictions.push_back(sentence);
  result.failed.push_back(sentence);
}

std::string instability_text(const meshes::Instability& at, const char* where) {
  return "the law is unstable (Drucker) from the stretch " + rounded(at.stretch) + " on in " +
         std::string(name(at.test)) + " tests, which is " + where;
}

std::string size_text(double share) {
  return rounded(100.0 * share, 3) + " %";
}

bool is_zero(MaterialParameter parameter) {
  return parameter == MaterialParameter::stress_zero || parameter == MaterialParameter::strain_zero;
}

void add_open_coefficients(LawFit& result) {
  const CurveFit& fit = result.fit;
  auto& told = result.contradictions;
  if (!fit.converged) fail(result, "the search ended before its minimum");
  for (std::size_t i = 0; i < fit.parameters.size(); ++i)
    if (fit.at_bound[i] && !is_zero(fit.parameters[i]))
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

/// What makes a stress vanish elsewhere than at rest, and what to do.
constexpr const char* of_strain =
    ". An unloading of a specimen that has kept a set, slack, or a wrong zero of the strain: give "
    "the loading from rest on, or write zero = \"fit\" in its strain";

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

/// Of a test whose rows begin away from rest, and whose stress vanishes nearer to the first of them
/// than to rest: why it is no loading from rest; "": it may be.
std::string begins_without_stress(const MaterialTest& test) {
  constexpr double far = 0.05, nearer = 0.6;
  if (test.course != TestCourse::slow || test.kind == TestKind::volumetric ||
      test.strain_zero_sought)
    return "";
  const double rest = rest_of(test.kind);
  const auto away = [&](double deformation) { return std::abs(deformation - rest); };
  const double first = *std::ranges::min_element(test.deformation, {}, away);
  const auto vanishes = where_stress_vanishes(test);
  if (!vanishes || away(first) < far * reach_of(test) || *vanishes / (first - rest) < nearer)
    return "";
  return test.name + " does not go through rest: its stress vanishes at the deformation " +
         rounded(rest + *vanishes, 4) + ", where its rows begin, and not at " + rounded(rest, 1) +
         of_strain;
}

/// Where the stress of a slow test has its largest mean over a tenth of its rows, if it falls
/// beyond.
std::optional<double> falls_beyond(const MaterialTest& test) {
  if (test.kind == TestKind::volumetric || test.course != TestCourse::slow) return {};
  const double rest = rest_of(test.kind);
  std::vector<std::pair<double, double>> rows;  // strain from rest, stress, away from rest
  for (std::size_t i = 0; i < test.stress.size(); ++i)
    rows.emplace_back(std::abs(test.deformation[i] - rest), test.stress[i]);
  // Of both sides the further strained one.
  const bool pulled =
      std::abs(test.deformation.back() - rest) > std::abs(test.deformation.front() - rest);
  std::erase_if(rows, [&, i = std::size_t{0}](const auto&) mutable {
    return (test.deformation[i++] > rest) != pulled;
  });
  if (!pulled) std::ranges::reverse(rows);
  const std::size_t few = std::max<std::size_t>(3, rows.size() / 10);
  if (rows.size() < 3 * few) return {};
  double noise = 0.0;  // by second differences, which a smooth curve has hardly any of
  for (std::size_t i = 2; i < rows.size(); ++i)
    noise += std::pow(rows[i].second - 2.0 * rows[i - 1].second + rows[i - 2].second, 2) /
             (6.0 * double(rows.size() - 2));
  const double surely_falls = 4.0 * std::sqrt(2.0 * noise / double(few));
  double largest = 0.0, last = 0.0, where = 0.0;
  for (std::size_t i = 0; i + few <= rows.size(); ++i) {
    double strain = 0.0, stress = 0.0;
    for (std::size_t k = i; k < i + few; ++k)
      strain += rows[k].first / double(few), stress += rows[k].second / double(few);
    last = std::abs(stress);
    if (last > largest) largest = last, where = strain;
  }
  return largest - last > std::max(fall * largest, surely_falls) ? std::optional(where)
                                                                 : std::nullopt;
}

double mean_factor(const std::vector<PartErrors>& parts, const PartErrors* without) {
  double sum = 0.0, count = 0.0;
  for (const PartErrors& each : parts)
    if (&each != without) sum += each.factor, count += 1.0;
  return sum / count;
}

/// What makes a part of a test so many times stiffer than the others.
struct FactorCause {
  const char* question;
  bool (*is)(const TestPart& part, double times);
};
bool shears(const TestPart& part) {
  return part.way == name(TestKind::simple_shear);
}
bool is_column(const TestPart& part) {
  return part.way == name(DeformationMode::compression);
}
constexpr FactorCause factor_causes[] = {
    {"Is its strain displacement over height, which is twice the tensor's? ",
     [](const TestPart& part, double times) {
       return shears(part) && (times < 0.6 || times > 1.7);
     }},
    {"Do its plates hold the ends (friction), so that the column bulges? Give diameter and height "
     "(plates). ",
     [](const TestPart& part, double times) { return is_column(part) && times > 1.0; }},
    {"Is it planar, its width held, or pulled both ways (equibiaxial)? ",
     [](const TestPart& part, double times) {
       return part.way == "planar tension" && times > 1.2;
     }},
    {"Is it compressible (a foam)? ", [](const TestPart& part, double times) {
       return shears(part) ? times > 1.0 : part.way != "planar tension" && times < 1.0;
     }}};

/// Of parts that differ: whether their factors grow with the rates of their tests, and by how many
/// times these differ; 1: no.
double growth_with_rate(const std::vector<MaterialTest>& tests,
                        const std::vector<PartErrors>& parts) {
  std::vector<std::pair<double, double>> known;
  for (const PartErrors& each : parts)
    if (const auto& rate = tests[each.test].rate) known.emplace_back(*rate, each.factor);
  std::ranges::sort(known);
  const bool grows = known.size() == parts.size() &&
                     std::ranges::is_sorted(known, {}, &std::pair<double, double>::second);
  return grows ? known.back().first / known.front().first : 1.0;
}

/// Tests, or sides of one, whose stresses no one rubber has.
void add_factors(LawFit& result, const std::vector<MaterialTest>& tests) {
  constexpr double other_rate = 3.0;
  const auto off = [](const PartErrors& each) { return std::abs(std::log(each.factor)); };
  const std::vector<PartErrors>& parts = result.parts;
  if (parts.size() < 2) return;
  const auto [least, most] = std::ranges::minmax_element(parts, {}, &PartErrors::factor);
  if (!(most->factor > largest_ratio * least->factor)) return;
  const PartErrors* worst = &*std::ranges::max_element(parts, {}, off);
  const auto times_of = [&](const PartErrors& each) {
    return each.factor / mean_factor(parts, &each);
  };
  // Of two either may be the one: that which has a cause, else the second.
  std::vector<const PartErrors*> perhaps = {worst};
  if (parts.size() == 2) worst = &parts[1], perhaps = {&parts[1], &parts[0]};
  std::string question;
  for (const FactorCause& cause : factor_causes)
    for (const PartErrors* each : perhaps)
      if (question.empty() && cause.is(each->part, times_of(*each)))
        question = cause.question, worst = each;
  std::string moduli;
  for (const PartErrors& each : parts) {
    const char* link = &each == &parts.front() ? "" : &each == &parts.back() ? " and " : ", ";
    moduli += link + rounded((*result.modulus)[0] * each.factor, 3) + " Pa in " + each.part.name;
  }
  const double times = times_of(*worst), rates = growth_with_rate(tests, parts);
  const bool one_way = std::ranges::all_of(
      parts, [&](const PartErrors& each) { return each.part.way == worst->part.way; });
  std::string sentence =
      "tests contradict each other: " + worst->part.name + " bears " + rounded(times, 3) +
      " times the stress that the others ask of it by this law, G = " + moduli + ". ";
  if (rates > other_rate)
    sentence +=
        "Their rates differ " + rounded(rates, 2) +
        " times, and G grows with them, so that the rubber likely relaxes: fit tests of one "
        "rate, or tests in time (kind = \"relaxation\" or \"cycles\") with a law +prony";
  else if (one_way)
    sentence +=
        "Specimens that scatter are one test: path = [...] of all of them, whose mean is "
        "fitted and whose scatter the intervals have. Else look at areas, lengths and "
        "batches";
  else
    sentence += question + "Else look at areas, lengths, zeros, and specimens of another batch";
  fail(result, sentence);
}

/// Tests that do not go through rest, and stresses that fall.
void add_rest(LawFit& result, const std::vector<MaterialTest>& tests) {
  constexpr double far = 3.0;
  for (std::size_t t = 0; t < tests.size(); ++t) {
    const MaterialTest& test = tests[t];
    if (const auto strain = falls_beyond(test))
      fail(result,
           "the stress of " + test.name + " falls beyond the strain " + rounded(*strain, 2) +
               ": does the specimen slide out of its grips, yield or tear? Leave those rows "
               "out");
    if (const std::string sentence = begins_without_stress(test); !sentence.empty()) {
      fail(result, sentence);
      continue;
    }
    if (result.usual.empty()) continue;
    const UsualZeros& zeros = result.usual[t];
    const std::string begin = test.name + " does not go through rest: the law asks for ";
    const double most = largest_stress(test);
    if (!(std::abs(zeros.at_rest) > far * std::hypot(zeros.at_rest_usual, zeros.at_rest_error)))
      continue;
    if (std::abs(zeros.stress) / most > std::abs(zeros.strain) / reach_of(test))
      fail(result,
           begin + rounded(zeros.stress, 3) + " Pa there, " +
               percent(std::abs(zeros.stress) / most) +
               " of the largest. The load cell's zero, or a set or slack of the specimen: "
               "write zero = \"fit\" in its stress, or in its strain, or give rows at rest");
    else
      fail(result, begin + "a stress that vanishes at the deformation " +
                       rounded(rest_of(test.kind) + zeros.strain, 4) + " and not at " +
                       rounded(rest_of(test.kind), 1) + of_strain);
  }
}

void add_misfits(LawFit& result, const std::vector<MaterialTest>& tests) {
  for (const PartErrors& each : result.parts) {
    if (each.misfit > largest_misfit)
      fail(result, "the law does not describe the data: " + each.part.name + " is missed by " +
                       size_text(each.misfit) + " (rms), noise taken off");
    else if (each.misfit_seen && each.misfit > little_misfit)
      result.contradictions.push_back("the model misses something of " + each.part.name + ": " +
                                      size_text(each.misfit) + " (rms), noise taken off");
  }
  const auto is_judged = [&](std::size_t t) {
    return std::ranges::find(result.parts, t, &PartErrors::test) != result.parts.end();
  };
  if (result.parts.empty() && result.fit.chi_square_probability && result.fit.birge_ratio == 1.0)
    return;
  for (std::size_t t = 0; t < tests.size(); ++t)
    for (const TestPart& part : parts_of(tests[t])) {
      if (is_judged(t)) continue;
      Eigen::VectorXd measured(Index(part.points.size())), residuals = measured;
      for (Index i = 0; i < measured.size(); ++i) {
        const std::size_t p = part.points[std::size_t(i)];
        measured(i) = tests[t].stress[p];
        residuals(i) = measured(i) - result.fitted[t].stress[p];
      }
      if (const auto sentence = missed("the law", part.name, residuals, measured, largest_misfit))
        fail(result, *sentence);
    }
}

}  // namespace

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
  add_factors(result, tests);
  add_rest(result, tests);
  if (const ModulusOfLaws g = modulus_of(result); is_open("Pa", g.value, g.lower, g.upper))
    fail(result, "G at rest is not determined by these tests: its 95 % interval is " +
                     rounded(g.lower, 3) + " to " + rounded(g.upper, 3) + " Pa");
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
