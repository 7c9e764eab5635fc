#include "calibration/material_tests/law_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numeric>

#include "calibration/files/words.h"
#include "calibration/material_tests/law_contradictions.h"
#include "calibration/material_tests/law_posterior.h"
#include "calibration/material_tests/law_starts.h"
#include "calibration/material_tests/relaxation_starts.h"
#include "calibration/material_tests/zeroed_model.h"
#include "calibration/statistics/curve_fit.h"
#include "calibration/statistics/fit_statistics.h"
#include "meshes/base/errors.h"
#include "meshes/press/press_response.h"

namespace fingertip::calibration::inline material_tests {

using Eigen::Index;
using Eigen::VectorXd;
using meshes::InvalidInput;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double point_floor = 0.05;  // TestWeights::point, of the largest stress

double root_mean_square(const std::vector<double>& values) {
  return VectorXd::Map(values.data(), Index(values.size())).norm() /
         std::sqrt(double(values.size()));
}

std::vector<double> scales_of(const MaterialTest& test, TestWeights weights) {
  const std::size_t points = test.stress.size();
  if (weights == TestWeights::stress) return std::vector<double>(points, 1.0);
  if (weights == TestWeights::test)
    return std::vector<double>(points, root_mean_square(test.stress));
  std::vector<double> scales;
  const double least = point_floor * largest_stress(test);
  for (const double stress : test.stress) scales.push_back(std::max(std::abs(stress), least));
  return scales;
}

Curve scaled_curve(const MaterialTest& test, const std::vector<double>& scales) {
  Curve curve{test.name,   "point [1]", "stress over its scale [1]",
              test.stress, test.stress, test.sigma};
  std::iota(curve.x.begin(), curve.x.end(), 1.0);
  for (std::size_t i = 0; i < scales.size(); ++i) {
    curve.y[i] /= scales[i];
    if (!curve.sigma.empty()) curve.sigma[i] /= scales[i];
  }
  return curve;
}

bool is_volumetric(const MaterialTest& test) {
  return test.kind == TestKind::volumetric;
}

void check_tests(const std::vector<MaterialTest>& tests) {
  std::vector<meshes::Violation> found;
  for (const MaterialTest& test : tests)
    for (meshes::Violation& violation : test.violations()) found.push_back(std::move(violation));
  if (std::ranges::all_of(tests, is_volumetric))
    found.push_back({"tests", tests.empty() ? "none" : "volumetric",
                     "a law is fitted to at least one test that changes the shape",
                     "give a tension, compression or shear test"});
  if (!found.empty()) throw InvalidInput(found);
}

/// K joins the coefficients where a test tells it; its start is the test's own.
void add_bulk_modulus(const std::vector<MaterialTest>& tests, CurveFitOptions& options) {
  double product = 0.0, square = 0.0;
  for (const MaterialTest& test : tests) {
    if (!is_volumetric(test)) continue;
    for (std::size_t i = 0; i < test.stress.size(); ++i) {
      const double unit = mean_stress(1.0, test.deformation[i]);
      product += unit * test.stress[i];
      square += unit * unit;
    }
  }
  if (square == 0.0) return;
  const double k = product / square;
  if (!(k > 0.0))
    throw InvalidInput({"stress", rounded(k) + " Pa",
                        "a smaller volume needs pressure, which is a negative mean stress",
                        "give the column's sign"});
  options.free.push_back({MaterialParameter::bulk_modulus, k, 1e-3 * k, 1e3 * k});
  for (VectorXd& start : options.other_starts) {
    start.conservativeResize(start.size() + 1);
    start(start.size() - 1) = k;
  }
}

double corrected_criterion(const CurveFit& fit, Index points, bool has_sigma) {
  const double n = double(points), k = double(fit.estimates.size()) + (has_sigma ? 0.0 : 1.0);
  const double squares = sum_of_squares(fit.residuals);
  const double misfit =
      has_sigma ? fit.chi_square.value_or(squares) : n * std::log(std::max(squares, 1e-300) / n);
  return misfit + aicc_penalty(n, k);
}

/// Of a test whose zeros are taken off it may begin beyond rest.
TestMisfit misfit_of(const LawFit& fit, const MaterialTest& test, TestWeights weights) {
  const std::vector<double> scales = scales_of(test, weights);
  TestMisfit misfit;
  misfit.name = test.name;
  misfit.points = test.stress.size();
  const auto range = stretch_range({test});
  misfit.in_range = range[0] >= 0.999 * fit.tested[0] && range[1] <= 1.001 * fit.tested[1];
  CurveSlopes answer;
  try {
    answer = LawModel(test, scales, fit.choice, fit.fit.parameters).evaluate(fit.fit.estimates);
  } catch (const meshes::NotConverged&) {  // beyond the limit of a gent law
    misfit.rms = misfit.sum_of_squares = misfit.rms_relative = misfit.largest_relative = infinite;
    misfit.stress.assign(misfit.points, infinite);
    return misfit;
  }
  VectorXd residuals(answer.value.size());
  const int freedom = fit.fit.degrees_of_freedom;
  const double quantile = test.sigma.empty() && freedom > 0 ? student_95(freedom) : normal_95();
  int inside = 0;
  for (Index i = 0; i < residuals.size(); ++i) {
    const std::size_t p = std::size_t(i);
    misfit.stress.push_back(answer.value(i) * scales[p]);
    residuals(i) = test.stress[p] - misfit.stress.back();
    const Eigen::RowVectorXd slope = answer.jacobian.row(i);
    const double deviation =
        test.sigma.empty() ? fit.fit.residual_deviation : test.sigma[p] / scales[p];
    const double spread = std::sqrt(slope.dot(slope * fit.fit.covariance) + deviation * deviation);
    if (std::abs(residuals(i)) <= quantile * fit.fit.birge_ratio * spread * scales[p]) ++inside;
  }
  misfit.sum_of_squares = residuals.squaredNorm();
  misfit.rms = std::sqrt(misfit.sum_of_squares / double(misfit.points));
  misfit.rms_relative = misfit.rms / root_mean_square(test.stress);
  misfit.largest_relative = residuals.cwiseAbs().maxCoeff() / largest_stress(test);
  misfit.within = freedom > 0 ? double(inside) / double(misfit.points) : meshes::unknown;
  misfit.structure = residual_structure(residuals);
  if (test.course == TestCourse::cycles) {
    misfit.loop_measured = loop_area(test, test.stress);
    misfit.loop_computed = loop_area(test, misfit.stress);
  }
  return misfit;
}

}  // namespace

TestMisfit predict(const LawFit& fit, const MaterialTest& test, TestWeights weights) {
  const std::vector<meshes::Violation> broken = test.violations();
  if (!broken.empty()) throw InvalidInput(broken);
  return misfit_of(fit, test, weights);
}

namespace {

/// Fits by their names, from which others begin.
using Fits = std::map<std::string, LawFit>;

const LawFit& fitted(const std::vector<MaterialTest>& tests, const LawChoice& choice,
                     const LawFitOptions& options, Fits& done);

/// The search for a law and its relaxation: from the law alone, then from a branch less, then from
/// the laws that are cases of it.
CurveFitOptions starts_of(const std::vector<MaterialTest>& tests,
                          const std::vector<std::vector<double>>& scales, const LawChoice& choice,
                          const LawFitOptions& options, Fits& done) {
  CurveFitOptions fit = law_starts(tests, scales, choice, options);
  if (choice.branches > 0) {
    const auto with = [&](int branches) -> const LawFit& {
      return fitted(tests, {choice.law, choice.terms, branches}, options, done);
    };
    add_branches(tests, scales, choice, with(0), with(choice.branches - 1), fit);
  }
  for (const LawChoice& nested : nested_laws(choice)) {
    try {
      const LawFit& found = fitted(tests, nested, options, done);
      for (const VectorXd& start : as_more_general(nested, found.fit.estimates, choice))
        fit.other_starts.push_back(within_bounds(start, fit.free));
    } catch (const meshes::NotConverged&) {  // nothing to begin from
    }
  }
  add_bulk_modulus(tests, fit);
  fit.max_iterations = 200;
  fit.relative_singular_value = 0.0;  // closed forms have no error: intervals tell what is open
  return fit;
}

void check_points(Index points, Index coefficients, const LawChoice& choice) {
  if (points > coefficients) return;
  throw InvalidInput({"tests", std::to_string(points) + " points",
                      "more points than the " + std::to_string(coefficients) + " coefficients of " +
                          name(choice) + " are needed",
                      "give further tests, or a law of fewer coefficients"});
}

LawFit fit_with(const std::vector<MaterialTest>& tests, const LawChoice& choice,
                const LawFitOptions& options, Fits& done) {
  check_tests(tests);
  LawFit result;
  result.times = observed_times(tests);
  if (choice.branches > 0 && !result.times)
    throw InvalidInput({"tests", name(choice), "a relaxation shows in tests with times alone",
                        "give a relaxation test or cycles, or a law without prony"});
  LawCurves data{tests, {}, {}};
  Index points = 0;
  for (const MaterialTest& test : tests) {
    data.scales.push_back(scales_of(test, options.weights));
    data.curves.push_back(scaled_curve(test, data.scales.back()));
    points += Index(test.stress.size());
  }
  const std::vector<Curve>& curves = data.curves;
  const CurveFitOptions law = starts_of(tests, data.scales, choice, options, done);
  CurveFitOptions fit = law;
  result.zeros = add_zeros(tests, false, fit);
  const std::vector<MaterialParameter> parameters = parameters_in(fit);
  check_points(points, Index(parameters.size()), choice);
  std::vector<std::unique_ptr<ZeroedModel>> models;
  std::vector<ForwardModel*> addresses;
  for (std::size_t t = 0; t < tests.size(); ++t) {
    models.push_back(std::make_unique<ZeroedModel>(tests[t], data.scales[t], choice, parameters,
                                                   result.zeros[t]));
    addresses.push_back(models.back().get());
  }
  result.choice = choice;
  result.fit = fit_curves(curves, addresses, fit);
  if (const auto sorted = sorted_branches(choice, result.fit.estimates)) {
    const VectorXd start = within_bounds(*sorted, fit.free);
    for (Index i = 0; i < start.size(); ++i) fit.free[std::size_t(i)].start = start(i);
    fit.start_once();
    result.fit = fit_curves(curves, addresses, fit);
  }
  result.aicc = corrected_criterion(result.fit, points, !curves.front().sigma.empty());
  const auto is_slow = [](const MaterialTest& test) { return test.course == TestCourse::slow; };
  if (std::ranges::all_of(tests, is_slow)) add_posterior(data, law, result);
  // Squares of the number of points, which a ranking would keep for every law.
  result.fit.whitening.resize(0, 0);
  result.fit.influence.resize(0, 0);
  result.law = sized_law(choice, result.fit.estimates);
  result.relaxation = relaxation_of(choice, result.fit.estimates);
  const auto bulk = std::ranges::find(parameters, MaterialParameter::bulk_modulus);
  if (bulk != parameters.end())
    result.bulk_modulus = result.fit.estimates(Index(bulk - parameters.begin()));
  std::vector<MaterialTest> zeroed;
  const auto found = [&](const std::optional<Index>& place) {
    return place ? result.fit.estimates(*place) : 0.0;
  };
  for (std::size_t t = 0; t < tests.size(); ++t)
    zeroed.push_back(
        without_zeros(tests[t], found(result.zeros[t].stress), found(result.zeros[t].strain)));
  result.tested = stretch_range(zeroed);
  for (std::size_t t = 0; t < tests.size(); ++t) {
    TestMisfit& test = result.fitted.emplace_back(misfit_of(result, zeroed[t], options.weights));
    test.stress_zero = found(result.zeros[t].stress);
    test.strain_zero = found(result.zeros[t].strain);
  }
  // The further strained side of a test comes first.
  for (auto part = result.parts.rbegin(); part != result.parts.rend(); ++part) {
    TestMisfit& test = result.fitted[part->test];
    test.factor = part->factor;
    test.misfit = std::fmax(test.misfit, part->misfit);
  }
  result.untested = untested_modes(result, zeroed, options);
  add_contradictions(result, zeroed, options);
  return result;
}

const LawFit& fitted(const std::vector<MaterialTest>& tests, const LawChoice& choice,
                     const LawFitOptions& options, Fits& done) {
  const auto known = done.find(name(choice));
  if (known != done.end()) return known->second;
  LawFit fit = fit_with(tests, choice, options, done);
  return done.emplace(name(choice), std::move(fit)).first->second;
}

}  // namespace

LawFit fit_law(const std::vector<MaterialTest>& tests, const LawChoice& choice,
               const LawFitOptions& options) {
  Fits done;
  return fit_with(tests, choice, options, done);
}

std::vector<LawFit> rank_laws(const std::vector<MaterialTest>& tests,
                              const std::vector<MaterialTest>& validation,
                              const std::vector<LawChoice>& laws, const LawFitOptions& options,
                              const std::function<void(double, const LawChoice&)>& next) {
  check_tests(tests);
  std::vector<LawFit> ranking;
  Fits done;
  for (const LawChoice& law : laws) {
    if (next) next(double(ranking.size()) / double(laws.size()), law);
    LawFit fit;
    try {
      fit = fitted(tests, law, options, done);
      for (const MaterialTest& test : validation)
        fit.predicted.push_back(predict(fit, test, options.weights));
      add_missed_predictions(fit);
    } catch (const std::exception& error) {
      fit = LawFit();
      fit.choice = law;
      fit.aicc = infinite;
      fit.failure = error.what();
    }
    ranking.push_back(std::move(fit));
  }
  std::ranges::stable_sort(ranking, [](const LawFit& a, const LawFit& b) {
    if (a.failure.empty() != b.failure.empty()) return a.failure.empty();
    return a.aicc < b.aicc;
  });
  add_differences(equals(ranking), ranking);
  return ranking;
}

namespace {

using Laws = std::vector<const LawFit*>;

/// So well do specimens repeat.
constexpr double repeatable = 0.02;
/// So much more stress is no wilder.
constexpr double little_more = 1.1;

double worst(const std::vector<TestMisfit>& misfits) {
  double error = 0.0;
  for (const TestMisfit& misfit : misfits) error = std::max(error, misfit.rms_relative);
  return error;
}

/// That law, or one that is a case of it and fits and predicts as well.
const LawFit* simplest(const Laws& laws, const LawFit* chosen) {
  for (const LawChoice& nested : nested_laws(chosen->choice))
    for (const LawFit* law : laws)
      if (law->choice == nested && law->aicc <= chosen->aicc + as_good_aicc &&
          worst(law->predicted) <= worst(chosen->predicted) + repeatable)
        return simplest(laws, law);
  return chosen;
}

const LawFit* best_supported(const Laws& laws) {
  for (const LawFit* law : laws)
    if (worst(law->predicted) <= supporting_error) return simplest(laws, law);
  return *std::ranges::min_element(laws, {}, [](const LawFit* law) {
    return std::max(worst(law->fitted), worst(law->predicted));
  });
}

/// By how many times it asks for more stress, beside that of the way tested, than the law that asks
/// for least does.
double wildness(const LawFit& law, const Laws& laws) {
  double most = 1.0;
  for (std::size_t i = 0; i < law.untested.size(); ++i) {
    const auto share = [&](const LawFit* each) { return each->untested[i].share; };
    most = std::max(most, share(&law) / share(*std::ranges::min_element(laws, {}, share)));
  }
  return most;
}

}  // namespace

ModulusOfLaws modulus_of_laws(const std::vector<LawFit>& ranking, const LawFit& taken) {
  const auto stable = [](const LawFit& fit) {
    return fit.failure.empty() && !fit.unstable_in_tests && !fit.unstable_in_use &&
           !fit.unstable_in_press;
  };
  const auto best = std::ranges::find_if(ranking, stable);
  const double best_aicc = best == ranking.end() ? taken.aicc : best->aicc;
  ModulusOfLaws all = modulus_of(taken);
  all.laws.clear();
  std::vector<double> values, deviations, weights;
  double sum = 0.0;
  for (const LawFit& fit : ranking) {
    if (&fit != &taken && !(stable(fit) && fit.aicc <= best_aicc + as_good_aicc)) continue;
    const ModulusOfLaws own = modulus_of(fit);
    if (&fit != &taken && !(own.upper - own.lower <= own.value)) continue;
    all.laws.push_back(&fit);
    values.push_back(0.5 * (own.lower + own.upper));
    deviations.push_back((own.upper - own.lower) / (2.0 * normal_95()));
    // What is taken counts as much as any.
    weights.push_back(&fit == &taken ? 1.0 : std::exp(-0.5 * std::max(0.0, fit.aicc - best_aicc)));
    sum += weights.back();
  }
  if (all.laws.size() < 2) return all;
  for (double& weight : weights) weight /= sum;
  all.lower = std::min(all.value, mixture_point(values, deviations, weights, 0.025));
  all.upper = std::max(all.value, mixture_point(values, deviations, weights, 0.975));
  return all;
}

std::vector<const LawFit*> equals(const std::vector<LawFit>& ranking) {
  Laws laws;
  for (const LawFit& fit : ranking)
    if (fit.failure.empty() && fit.failed.empty()) laws.push_back(&fit);
  if (laws.empty() || !laws.front()->predicted.empty() || laws.front()->untested.empty())
    return laws;
  double least = infinite;
  for (const LawFit* law : laws) least = std::min(least, worst(law->fitted));
  std::erase_if(laws, [&](const LawFit* law) { return worst(law->fitted) > least + repeatable; });
  return laws;
}

const LawFit* recommended(const std::vector<LawFit>& ranking) {
  if (const Laws laws = equals(ranking); !laws.empty()) {
    if (!laws.front()->predicted.empty()) return best_supported(laws);
    const auto wild = [&](const LawFit* law) { return wildness(*law, laws); };
    const double tamest = wild(*std::ranges::min_element(laws, {}, wild));
    return simplest(laws, *std::ranges::find_if(laws, [&](const LawFit* law) {
                      return wild(law) <= little_more * tamest;
                    }));
  }
  auto found = std::ranges::find_if(ranking, [](const LawFit& fit) {
    return fit.failure.empty() && !fit.unstable_in_tests && !fit.unstable_in_use &&
           !fit.unstable_in_press;
  });
  if (found == ranking.end()) found = ranking.begin();
  return found == ranking.end() || !found->failure.empty() ? nullptr : &*found;
}

}  // namespace fingertip::calibration::inline material_tests
