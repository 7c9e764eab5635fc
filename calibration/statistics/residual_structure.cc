#include "calibration/statistics/residual_structure.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace fingertip::calibration::inline statistics {

namespace {

/// Share below which chance is no longer believed.
constexpr double unlikely = 0.05;

/// n over k; 0 outside of the triangle.
double choose(int n, int k) {
  if (k < 0 || k > n) return 0.0;
  return std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0));
}

/// Of exactly `runs` runs of p positive and m negative signs.
double probability_of(int runs, int p, int m) {
  const int half = runs / 2;
  // Divided before it is multiplied, so that nothing overflows below 1000 points.
  const double all = choose(p + m, p);
  if (runs % 2 == 0) return 2.0 * (choose(p - 1, half - 1) / all) * choose(m - 1, half - 1);
  return (choose(p - 1, half) / all) * choose(m - 1, half - 1) +
         (choose(p - 1, half - 1) / all) * choose(m - 1, half);
}

std::string statement_of(int runs, int points, double probability) {
  if (points < 2) return "there are too few residuals to see a structure";
  char chance[32];
  std::snprintf(chance, sizeof chance, "%.2g", 100.0 * probability);
  std::string text = runs == 1
                         ? "all " + std::to_string(points) +
                               " residuals have the same sign; chance would do so in " + chance
                         : "the residuals change sign " + std::to_string(runs - 1) +
                               (runs == 2 ? " time" : " times") + " in " + std::to_string(points) +
                               " points; chance would do so, or less often, in " + chance;
  text += " % of cases: ";
  return text + (probability < unlikely ? "the model misses something"
                                        : "that is no sign of something missed");
}

}  // namespace

ResidualStructure residual_structure(const Eigen::VectorXd& residuals) {
  ResidualStructure found;
  int positive = 0, negative = 0;
  double before = 0.0;
  for (const double residual : residuals) {
    if (residual == 0.0) continue;
    ++(residual > 0.0 ? positive : negative);
    if (before == 0.0 || (before > 0.0) != (residual > 0.0)) ++found.runs;
    before = residual;
  }
  const int points = positive + negative;
  if (points >= 2 && found.runs == 1) found.probability = std::ldexp(1.0, 1 - points);
  if (found.runs > 1) {
    found.probability = 0.0;
    for (int runs = 2; runs <= int(found.runs); ++runs)
      found.probability += probability_of(runs, positive, negative);
    found.probability = std::min(found.probability, 1.0);
  }
  found.statement = statement_of(int(found.runs), points, found.probability);
  return found;
}

}  // namespace fingertip::calibration::inline statistics
