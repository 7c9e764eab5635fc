#include "calibration/material_tests/law_starts.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <utility>

#include "calibration/statistics/non_negative.h"
#include "meshes/base/errors.h"

namespace fingertip::calibration::inline material_tests {

using Eigen::Index;
using Eigen::VectorXd;
using meshes::RubberLaw;

namespace {

/// Beyond it l^alpha is a number without meaning.
constexpr double largest_exponent = 25.0;
/// Searches for ogden begin with the best of so many sets of exponents that are drawn.
constexpr int max_starts = 8, guess_count = 400;
/// A term of so small a share of G is none.
constexpr double smallest_share = 1e-6;

/// Tests of shape as columns: stresses of a law with G = 1, and the stresses measured, scaled.
class ScaledTests {
 public:
  ScaledTests(const std::vector<MaterialTest>& tests,
              const std::vector<std::vector<double>>& scales)
      : tests_(tests), scales_(scales) {
    measured_ = column([](const MaterialTest& test, std::size_t i) { return test.stress[i]; });
  }

  const VectorXd& measured() const { return measured_; }

  VectorXd of(const meshes::StrainEnergy& energy) const {
    return column([&](const MaterialTest& test, std::size_t i) {
      const double factor = test.constraint.empty() ? 1.0 : test.constraint[i];
      return factor * test_stress({1.0, energy}, test.kind, test.measure, test.deformation[i]);
    });
  }

 private:
  template <typename Value>
  VectorXd column(const Value& value) const {
    std::vector<double> all;
    for (std::size_t t = 0; t < tests_.size(); ++t) {
      if (tests_[t].kind == TestKind::volumetric) continue;
      for (std::size_t i = 0; i < tests_[t].stress.size(); ++i)
        all.push_back(value(tests_[t], i) / scales_[t][i]);
    }
    return VectorXd::Map(all.data(), Index(all.size()));
  }

  const std::vector<MaterialTest>& tests_;
  const std::vector<std::vector<double>>& scales_;
  VectorXd measured_;
};

/// G of neo-Hooke that meets the tests best.
double neo_hookean_modulus(const ScaledTests& tests) {
  const VectorXd unit = tests.of({});
  const double g = unit.dot(tests.measured()) / unit.squaredNorm();
  if (!(g > 0.0) || !std::isfinite(g))
    throw meshes::InvalidInput({"stress", std::to_string(g) + " Pa",
                                "stresses must be positive in tension and shear, and negative in "
                                "compression",
                                "give the column's sign, or another definition of strain"});
  return g;
}

/// The largest I1 - 3 of the tests.
double largest_invariant(const std::vector<MaterialTest>& tests) {
  double largest = 0.0;
  for (const MaterialTest& test : tests) {
    if (test.kind == TestKind::volumetric) continue;
    for (const double deformation : test.all_deformations()) {
      const auto l = principal_stretches(test.kind, deformation);
      largest = std::max(largest, l[0] * l[0] + l[1] * l[1] + l[2] * l[2] - 3.0);
    }
  }
  return largest;
}

struct Guess {
  VectorXd coefficients;
  double misfit = 0.0;
};

/// mu_i of these exponents by non-negative least squares.
std::optional<Guess> with_exponents(const ScaledTests& tests, const std::vector<double>& exponents,
                                    double g) {
  const Index terms = Index(exponents.size());
  Eigen::MatrixXd columns(tests.measured().size(), terms);
  VectorXd sizes(terms);
  for (Index i = 0; i < terms; ++i) {
    meshes::StrainEnergy energy;
    energy.law = RubberLaw::ogden;
    energy.shape = {1.0, exponents[std::size_t(i)]};
    columns.col(i) = tests.of(energy);
    sizes(i) = columns.col(i).norm();
    if (!(sizes(i) > 0.0) || !std::isfinite(sizes(i))) return std::nullopt;
    columns.col(i) /= sizes(i);
  }
  Guess guess{VectorXd(2 * terms), 0.0};
  try {
    const VectorXd found = non_negative_least_squares(columns, tests.measured());
    guess.misfit = (columns * found - tests.measured()).squaredNorm();
    for (Index i = 0; i < terms; ++i) {
      guess.coefficients(2 * i) =
          std::clamp(found(i) / sizes(i), 10.0 * smallest_share * g, 1e3 * g);
      guess.coefficients(2 * i + 1) = exponents[std::size_t(i)];
    }
  } catch (const meshes::NotConverged&) {
    return std::nullopt;
  }
  return guess;
}

/// The best sets of exponents, the largest first in each, so that terms have an order.
std::vector<VectorXd> ogden_starts(const ScaledTests& tests, int terms, double g, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Guess> guesses;
  for (int n = 0; n < guess_count; ++n) {
    std::vector<double> exponents;
    for (int i = 0; i < terms; ++i) {
      // Small ones more often; the generator's own numbers are the same everywhere.
      const double u = 2.0 * double(random()) / double(std::mt19937::max()) - 1.0;
      const double alpha = 0.9 * largest_exponent * u * std::abs(u);
      exponents.push_back(std::abs(alpha) < 0.1 ? 2.0 : alpha);
    }
    std::ranges::sort(exponents, std::greater());
    const auto close = [](double a, double b) { return std::abs(a - b) < 0.3; };
    if (std::ranges::adjacent_find(exponents, close) != exponents.end()) continue;
    if (auto guess = with_exponents(tests, exponents, g)) guesses.push_back(std::move(*guess));
  }
  std::ranges::stable_sort(guesses, {}, &Guess::misfit);
  std::vector<VectorXd> starts;
  for (const Guess& guess : guesses) {
    if (int(starts.size()) == max_starts) break;
    // Another valley, or at least another side of this one.
    const bool known = std::ranges::any_of(starts, [&](const VectorXd& start) {
      double apart = 0.0;
      for (Index i = 1; i < start.size(); i += 2)
        apart = std::max(apart, std::abs(start(i) - guess.coefficients(i)));
      return apart < 0.5;
    });
    if (!known) starts.push_back(guess.coefficients);
  }
  if (starts.empty())
    throw meshes::NotConverged("no exponents of Ogden's law meet the tests at all");
  return starts;
}

double size(double value, double least) {
  return std::max(std::abs(value), least);
}

}  // namespace

CurveFitOptions law_starts(const std::vector<MaterialTest>& tests,
                           const std::vector<std::vector<double>>& scales, const LawChoice& choice,
                           const LawFitOptions& options) {
  const ScaledTests scaled(tests, scales);
  const double g = neo_hookean_modulus(scaled), above = std::max(largest_invariant(tests), 1e-6);
  CurveFitOptions fit;
  const std::vector<MaterialParameter> names = coefficients(choice);
  const auto add = [&](double start, double lower, double upper, double scale) {
    fit.free.push_back({names[fit.free.size()], start, lower, upper, std::nullopt, scale});
  };
  constexpr double endless = std::numeric_limits<double>::infinity();
  switch (choice.law) {
    case RubberLaw::yeoh:
      for (int i = 0; i < choice.terms; ++i)
        add(i == 0 ? 0.5 * g : 0.0, i == 0 ? smallest_share * g : -endless, endless,
            0.5 * g / std::pow(above, i));
      break;
    case RubberLaw::mooney_rivlin:
      add(0.45 * g, -endless, endless, 0.5 * g);
      add(0.05 * g, -endless, endless, 0.5 * g);
      break;
    case RubberLaw::gent:
      add(g, smallest_share * g, 1e3 * g, g);
      add(2.0 * above, 1.0001 * above, 1e4 * above, above);
      for (const double factor : {1.05, 1.3, 5.0, 50.0})
        fit.other_starts.push_back(Eigen::Vector2d(g, factor * above));
      break;
    case RubberLaw::ogden: {
      const std::vector<VectorXd> starts = ogden_starts(scaled, choice.terms, g, options.seed);
      for (Index i = 0; i < starts.front().size(); i += 2) {
        const double mu = starts.front()(i), alpha = starts.front()(i + 1);
        add(mu, smallest_share * g, 1e4 * g, size(mu, 1e-3 * g));
        add(alpha, -largest_exponent, largest_exponent, size(alpha, 1.0));
      }
      fit.other_starts.assign(starts.begin() + 1, starts.end());
      break;
    }
    default: add(g, smallest_share * g, 1e3 * g, g);
  }
  return fit;
}

std::vector<LawChoice> nested_laws(const LawChoice& choice) {
  const auto like = [&](RubberLaw law, int terms) {
    return LawChoice{law, terms, choice.branches};
  };
  const LawChoice neo = like(RubberLaw::neo_hookean, 1);
  switch (choice.law) {
    case RubberLaw::neo_hookean: return {};
    case RubberLaw::yeoh:
      return {choice.terms == 2 ? neo : like(RubberLaw::yeoh, choice.terms - 1)};
    case RubberLaw::ogden:
      if (choice.terms == 1) return {neo};
      if (choice.terms == 2) return {like(RubberLaw::ogden, 1), like(RubberLaw::mooney_rivlin, 1)};
      return {like(RubberLaw::ogden, choice.terms - 1)};
    default: return {neo};
  }
}

std::vector<VectorXd> as_more_general(const LawChoice& nested, const VectorXd& coefficients,
                                      const LawChoice& choice) {
  const VectorXd law = coefficients.head(Index(law_coefficients(nested).size()));
  const double first = law(0);
  std::vector<std::vector<double>> starts = {{law.begin(), law.end()}};
  if (choice.law == RubberLaw::gent) {
    starts = {{first, std::numeric_limits<double>::max()}};
  } else if (choice.law != RubberLaw::ogden) {
    if (nested.law == RubberLaw::neo_hookean) starts[0][0] = 0.5 * first;  // G = 2 C1
    starts[0].push_back(0.0);
  } else if (nested.law == RubberLaw::mooney_rivlin) {
    starts = {{2.0 * first, 2.0, 2.0 * law(1), -2.0}};
  } else if (nested.law == RubberLaw::neo_hookean) {
    starts[0].push_back(2.0);
  } else {
    const std::vector<double> known = std::exchange(starts, {}).front();
    for (const double exponent : {-4.0, 4.0, 12.0}) {
      starts.push_back(known);
      starts.back().insert(starts.back().end(), {1e-4 * first, exponent});
    }
  }
  std::vector<VectorXd> all;
  for (const std::vector<double>& start : starts) {
    VectorXd& whole = all.emplace_back(Index(start.size()) + 2 * choice.branches);
    whole << VectorXd::Map(start.data(), Index(start.size())),
        coefficients.segment(law.size(), 2 * choice.branches);
  }
  return all;
}

VectorXd within_bounds(VectorXd start, const std::vector<FreeParameter>& free) {
  for (Index i = 0; i < start.size(); ++i)
    start(i) = std::clamp(start(i), free[std::size_t(i)].lower, free[std::size_t(i)].upper);
  return start;
}

}  // namespace fingertip::calibration::inline material_tests
