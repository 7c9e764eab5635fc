#include "studies/fits/runs/fit_corrections.h"

#include <gtest/gtest.h>

#include <cmath>

#include "studies/files/shown_units.h"
#include "studies/fits/setup/configured_fit.h"
#include "tests/expectations.h"

using namespace fingertip;
using namespace fingertip::studies;

namespace {

/// F = p x: the least-squares estimate's influence is x/(x·x), or x/(1 + e)/(x·x) of a model that
/// is e too stiff.
struct StraightLine {
  std::vector<double> x = {1.0, 2.0, 3.0, 4.0};
  double truth = 5.0, error = 0.02;

  double estimate() const { return truth / (1.0 + error); }
  calibration::FitFile fit() const {
    calibration::FitFile file;
    file.statement = "Found.";
    file.influence.emplace_back();
    for (const double value : x) file.influence[0].push_back(value / (1.0 + error) / 30.0);
    calibration::ParameterEntry& parameter = file.parameters.emplace_back();
    parameter.name = "p", parameter.unit = "1", parameter.estimate = estimate();
    parameter.lower = 4.8, parameter.upper = 5.0;
    return file;
  }
};

TEST(FitCorrections, WhatStaysOpenIsRefused) {
  fingertip::calibration::FitFile fit;
  fit.parameters.resize(1);
  fit.parameters[0].name = "modulus";
  fit.parameters[0].unit = "Pa";
  fit.parameters[0].estimate = 60e3;
  fit.parameters[0].lower = 30e3;
  fit.parameters[0].upper = 90e3;
  refuse_what_is_open(fit);
  EXPECT_TRUE(fit.failed.empty());
  fit.parameters[0].lower = -11e3;
  fit.parameters[0].upper = 112e3;
  refuse_what_is_open(fit);
  ASSERT_EQ(fit.failed.size(), 1U);
  EXPECT_NE(fit.failed[0].find("modulus is not determined by these data"), std::string::npos);
  EXPECT_EQ(fit.statement.find("Not accepted: modulus"), 0U);
}

}  // namespace

TEST(FitBias, AModelThatIsTooStiffMakesTheEstimateTooSmall) {
  const StraightLine line;
  calibration::Curve curve;
  meshes::PressResponse continuum;
  for (const double x : line.x) {
    curve.x.push_back(x);
    curve.y.push_back(line.truth * x);  // met exactly: no residuals
    meshes::PressSample sample;
    sample.indentation = x;
    sample.normal_force = line.estimate() * x;  // of the truth's law, at the estimate
    continuum.append(sample);
  }
  const Eigen::VectorXd error = lattice_error(curve, {0.0, 0.0, 0.0, 0.0}, continuum);
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(error(i), line.estimate() * line.error * line.x[std::size_t(i)], 1e-12);

  calibration::FitFile fit = line.fit();
  add_bias(error, fit);
  const calibration::ParameterEntry& found = fit.parameters[0];
  const double bias = found.bias;
  // To first order in the error the true bias, estimate minus truth.
  EXPECT_NEAR(bias, line.estimate() - line.truth, 2.0 * line.truth * line.error * line.error);
  EXPECT_NEAR(found.lower, 4.8 - std::abs(bias), 1e-12);
  EXPECT_NEAR(found.upper, 5.0 + std::abs(bias), 1e-12);
  EXPECT_NE(fit.statement.find("shifted by -2"), std::string::npos) << fit.statement;
}

/// Whoever reads kPa and mm reads these in every sentence.
TEST(FitBias, SentencesOnAnotherContactAndOnTheBiasHaveUnits) {
  const auto fit = [](double modulus, double touch, double deviation) {
    calibration::FitFile file;
    const auto add = [&](const char* name, const char* unit, double value) {
      calibration::ParameterEntry& parameter = file.parameters.emplace_back();
      parameter.name = name, parameter.unit = unit, parameter.estimate = value;
      parameter.lower = 0.9 * value, parameter.upper = 1.1 * value;
    };
    add("modulus", "Pa", modulus), add("touch_offset", "m", touch), add("bond", "1", 0.5);
    file.residual_deviation = deviation;
    file.influence.assign(3, {0.0});
    return file;
  };
  calibration::FitFile first = fit(2.0e5, 2.0e-4, 0.0498);
  add_other_contact(fit(2.4162e5, 2.4807e-4, 0.0509), "stick", "frictionless", first);
  const auto shown = [&] { return in_shown_units(first.statement, Spelling::terminal); };
  EXPECT_NE(shown().find("With frictionless contact modulus = 241.62 kPa (95 %: 217.46 to 265.78); "
                         "touch_offset = 0.24807 mm (95 %: 0.22326 to 0.27288); bond = 0.5 (95 %: "
                         "0.45 to 0.55), residuals of 50.9 mN in place of 49.8 mN."),
            std::string::npos)
      << shown();
  add_bias(Eigen::VectorXd::Zero(1), first);
  EXPECT_NE(shown().find("are modulus 180 kPa to 265.78 kPa (shifted"), std::string::npos)
      << shown();
}

/// A shell (R = 10 mm, wall 2 mm) is 41 % softer at 3 mm, a dome 42 % stiffer.
TEST(FitBias, WhatFiniteStrainAddsHasASign) {
  EXPECT_TRUE(says(strain_words(0.16, -0.41),
                   "16 % of the rubber's thickness, where a neo-Hookean "
                   "solid is 41 % softer"));
  EXPECT_TRUE(says(strain_words(0.16, 0.42), "42 % stiffer"));
}

/// The continuum at two of four depths; between them the relative error is linear.
TEST(FitBias, FewSamplesOfTheContinuumSuffice) {
  calibration::Curve curve;
  curve.x = {1.0, 2.0, 3.0, 4.0};
  curve.y = {1.1, 2.0, 3.0, 4.0};
  meshes::PressResponse continuum;
  for (const auto& [x, force] : {std::pair{2.0, 2.0 / 1.25}, std::pair{4.0, 4.0 / 2.0}}) {
    meshes::PressSample sample;
    sample.indentation = x;
    sample.normal_force = force;
    continuum.append(sample);
  }
  // Relative errors, of the fitted force: 1 - 0.8 = 0.2 at x = 2, 0.5 at x = 4.
  const Eigen::VectorXd error = lattice_error(curve, {0.1, 0.0, 0.0, 0.0}, continuum);
  EXPECT_NEAR(error(0), 1.0 * 0.2, 1e-12) << "constant before the first, of the fitted force";
  EXPECT_NEAR(error(1), 2.0 * 0.2, 1e-12);
  EXPECT_NEAR(error(2), 3.0 * 0.35, 1e-12);
  EXPECT_NEAR(error(3), 4.0 * 0.5, 1e-12);
}
