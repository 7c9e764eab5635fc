#include "calibration/material_tests/law_contradictions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "calibration/material_tests/relaxation_starts.h"
#include "calibration/words.h"

namespace fingertip::calibration {

using Eigen::Index;

namespace {

/// Two coefficients of a higher correlation are one to the tests.
constexpr double collinear = 0.995;
/// Residuals of so unlikely an order show something that the law misses.
constexpr double unlikely_order = 0.05;
/// A prediction that misses by more contradicts the law.
constexpr double miss = 0.1;
/// Stretches that presses ask for, and StrainEnergy's own rule.
constexpr std::array<double, 2> press_range = {0.5, 2.0};

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
  if (!fit.converged) told.push_back("the search ended before its minimum");
  for (std::size_t i = 0; i < fit.parameters.size(); ++i)
    if (fit.at_bound[i])
      told.push_back(std::string(name(fit.parameters[i])) +
                     " ended at its bound: the tests ask for another law, or for fewer terms");
  for (const Direction& direction : fit.unidentifiable) told.push_back(direction.statement);
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
    result.contradictions.push_back(
        instability_text(*result.unstable_in_tests, "within the stretches of the fitted tests"));
  else if (result.unstable_in_use)
    result.contradictions.push_back(
        instability_text(*result.unstable_in_use, "within the stretches of use"));
  else if (result.unstable_in_press)
    result.contradictions.push_back(
        instability_text(*result.unstable_in_press, "within 0.5 to 2, which a press asks for"));
}

void add_misfits(LawFit& result) {
  for (const TestMisfit& misfit : result.fitted)
    if (misfit.structure.probability < unlikely_order)
      result.contradictions.push_back("residuals of " + misfit.test + " (rms " +
                                      size_text(misfit.rms_relative) +
                                      "): " + misfit.structure.statement);
}

}  // namespace

void add_contradictions(LawFit& result, const LawFitOptions& options) {
  add_instabilities(result, options);
  add_open_coefficients(result);
  if (result.times) result.open_branches = open_branches(result.relaxation, *result.times);
  result.contradictions.insert(result.contradictions.end(), result.open_branches.begin(),
                               result.open_branches.end());
  add_misfits(result);
}

void add_missed_predictions(LawFit& result) {
  for (const TestMisfit& misfit : result.predicted) {
    if (misfit.largest_relative <= miss && misfit.rms_relative <= miss) continue;
    result.contradictions.push_back(
        misfit.test + ", which was not fitted, is missed by " + size_text(misfit.rms_relative) +
        " (rms), " + size_text(misfit.largest_relative) + " at most" +
        (misfit.in_range ? "" : "; its stretches go beyond those of the fitted tests"));
  }
  for (const std::vector<TestMisfit>* list : {&result.fitted, &result.predicted})
    for (const TestMisfit& misfit : *list) {
      const double measured = misfit.loop_measured, computed = misfit.loop_computed;
      if (!(std::abs(computed - measured) > miss * std::abs(measured))) continue;
      result.contradictions.push_back("the loops of " + misfit.test + " hold " +
                                      rounded(measured, 3) + " J/m^3, those of the law " +
                                      rounded(computed, 3));
    }
}

}  // namespace fingertip::calibration
