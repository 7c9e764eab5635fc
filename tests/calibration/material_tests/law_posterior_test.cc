/// Zeros of stress and strain: sought beside a law, and told where nobody sought them.
#include "calibration/material_tests/law_posterior.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "calibration/material_tests/law_fit.h"
#include "calibration/material_tests/zeroed_model.h"

using namespace fingertip::calibration;
using Eigen::VectorXd;
using fingertip::meshes::RubberLaw;

namespace {

const LawChoice neo{RubberLaw::neo_hookean, 1}, mooney{RubberLaw::mooney_rivlin, 1},
    yeoh{RubberLaw::yeoh, 2}, ogden{RubberLaw::ogden, 2};

double normal(std::mt19937& random) {
  double sum = -6.0;
  for (int i = 0; i < 12; ++i) sum += double(random()) / double(std::mt19937::max());
  return sum;
}

/// A tension to `most`, the load cell at `stress`, the specimen already at the strain `strain`.
MaterialTest pulled(const LawChoice& choice, const VectorXd& coefficients, double stress,
                    double strain, double noise = 0.0, unsigned seed = 1, double most = 0.45,
                    int rows = 46) {
  std::mt19937 random(seed);
  const SizedLaw law = sized_law(choice, coefficients);
  MaterialTest test;
  test.name = "pulled";
  for (int i = 0; i < rows; ++i) {
    const double e = most * i / (rows - 1);
    test.deformation.push_back(1.0 + e + strain);
    test.stress.push_back(stress + test_stress(law, test.kind, test.measure, 1.0 + e) +
                          noise * normal(random));
  }
  return test;
}

TEST(LawZeros, SlopesAreThoseOfTheModel) {
  MaterialTest test = pulled(mooney, Eigen::Vector2d(20e3, 10e3), 0.0, 0.0);
  using enum MaterialParameter;
  const std::vector<MaterialParameter> parameters = {mooney_c10, mooney_c01, stress_zero,
                                                     strain_zero};
  ZeroedModel model(test, std::vector<double>(46, 2e3), mooney, parameters, {2, 3});
  const Eigen::Vector4d at(20e3, 10e3, 500.0, 0.02), size(1e3, 1e3, 1e2, 1e-2);
  const CurveSlopes answer = model.evaluate(at);
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector4d step = 1e-3 * size(k) * Eigen::Vector4d::Unit(k);
    const VectorXd slope =
        (model.evaluate(at + step).value - model.evaluate(at - step).value) / (2e-3 * size(k));
    EXPECT_LT((slope - answer.jacobian.col(k)).norm(), 1e-5 * slope.norm()) << k;
  }
  // The law at l - e0, and s0.
  const SizedLaw law = sized_law(mooney, at.head<2>());
  EXPECT_NEAR(answer.value(20) * 2e3,
              500.0 + test_stress(law, test.kind, test.measure, test.deformation[20] - 0.02), 1e-9);
}

TEST(LawZeros, AreFoundBesideTheLaw) {
  MaterialTest test = pulled(neo, VectorXd::Constant(1, 90e3), 6e3, 0.03, 400.0);
  test.stress_zero_sought = test.strain_zero_sought = true;
  // Both beside a modulus: a parabola's height and place, 400 Pa of noise.
  const LawFit fit = fit_law({test}, neo);
  ASSERT_EQ(fit.fit.estimates.size(), 3);
  const VectorXd truth = Eigen::Vector3d(90e3, 6e3, 0.03);
  for (int i = 0; i < 3; ++i)
    EXPECT_LT(std::abs(fit.fit.estimates(i) - truth(i)), 4.0 * fit.fit.standard_errors(i)) << i;
  EXPECT_EQ(fit.fit.labels[1], "stress_zero (pulled)");
  EXPECT_EQ(fit.fitted[0].stress_zero, fit.fit.estimates(1));
  EXPECT_LT(fit.fitted[0].rms_relative, 0.015);

  test = pulled(neo, VectorXd::Constant(1, 90e3), 6e3, 0.0, 400.0);
  test.stress_zero_sought = true;
  const LawFit one = fit_law({test}, neo);
  EXPECT_NEAR(one.fit.estimates(0), 90e3, 4.0 * one.fit.standard_errors(0));
  EXPECT_LT(one.fit.standard_errors(0), 0.01 * 90e3);
}

/// Of a load cell that stands at 6 kPa of 87 the laws made 112 (108 to 116) of G = 90 kPa.
TEST(LawZeros, ThatShowAreTold) {
  const std::vector<LawChoice>& laws = known_laws();
  for (const double zero : {6e3, -6e3})
    for (const double noise : {0.0, 400.0, 900.0}) {
      const MaterialTest test = pulled(neo, VectorXd::Constant(1, 90e3), zero, 0.0, noise);
      const std::vector<LawFit> ranking = rank_laws({test}, {}, laws);
      const LawFit& best = *recommended(ranking);
      ASSERT_FALSE(best.failed.empty()) << zero << " " << noise;
      EXPECT_NE(best.failed.back().find("pulled does not go through rest"), std::string::npos)
          << best.failed.back();
      MaterialTest known = without_zeros(test, zero, 0.0);
      known.stress_zero_known = true;
      for (const LawFit& fit : rank_laws({known}, {}, {neo}))
        for (const std::string& sentence : fit.failed)
          EXPECT_EQ(sentence.find("through rest"), std::string::npos);
    }
}

/// Of two tests of one name the one that has it is found.
TEST(LawZeros, ThatShowAreThoseOfTheirTestWhateverItsName) {
  const VectorXd rubber = VectorXd::Constant(1, 90e3);
  const std::vector<MaterialTest> tests = {pulled(neo, rubber, 0.0, 0.0, 100.0),
                                           pulled(neo, rubber, 6e3, 0.0, 100.0, 2)};
  std::vector<LawFit> ranking = rank_laws(tests, {}, {neo, mooney});
  ASSERT_FALSE(ranking.front().failed.empty());
  EXPECT_NE(ranking.front().failed.back().find("pulled does not go through rest"),
            std::string::npos);
}

/// The stress vanishes at the stretch 1.36 (41 rows from there to 3), or at 1.1 to 1.25.
TEST(LawZeros, AnUnloadingBranchDoesNotGoThroughRest) {
  for (const auto& laws : {known_laws(), std::vector{neo, mooney, yeoh}})
    for (const auto& [set, most] : {std::pair(1.36, 3.0), {1.1, 1.6}, {1.15, 1.9}, {1.25, 2.0}})
      for (const unsigned seed : {0U, 1U, 2U}) {
        std::mt19937 random(seed);
        MaterialTest test;
        test.name = "back";
        for (int i = 0; i <= 40; ++i) {
          const double l = set + (most - set) * i / 40.0, own = l / set;
          test.deformation.push_back(l);
          test.stress.push_back(60e3 * (own - 1.0 / (own * own)) +
                                (seed > 0 ? 600.0 * normal(random) : 0.0));
        }
        const std::vector<LawFit> ranking = rank_laws({test}, {}, laws);
        std::string text;
        for (const std::string& sentence : recommended(ranking)->failed) text += sentence + '\n';
        EXPECT_NE(text.find("does not go through rest"), std::string::npos)
            << set << " " << seed << ": " << text;
      }
}

/// Laws of every kind through rest, with noise and few rows, also of a law too simple for them.
TEST(LawZeros, DoNotShowWhereThereAreNone) {
  const std::vector<std::pair<LawChoice, VectorXd>> rubbers = {
      {neo, VectorXd::Constant(1, 60e3)},
      {mooney, Eigen::Vector2d(10e3, 20e3)},
      {yeoh, Eigen::Vector2d(20e3, 3e3)},
      {ogden, Eigen::Vector4d(12e3, 1.6, 3e3, -3.0)}};
  int draws = 0, told = 0;
  for (const auto& [law, coefficients] : rubbers)
    for (unsigned seed = 1; seed <= 10; ++seed) {
      const double most = 0.3 + 0.2 * seed, noise = seed % 2 == 0 ? 0.003 : 0.01;
      const double largest = pulled(law, coefficients, 0.0, 0.0, 0.0, 1, most).stress.back();
      const MaterialTest test =
          pulled(law, coefficients, 0.0, 0.0, noise * largest, seed, most, seed % 3 == 0 ? 20 : 60);
      for (const auto& laws : {std::vector{neo}, std::vector{neo, mooney, yeoh}}) {
        const std::vector<LawFit> ranking = rank_laws({test}, {}, laws);
        ++draws;
        for (const std::string& sentence : ranking.front().failed)
          told += sentence.find("through rest") != std::string::npos ? 1 : 0;
      }
    }
  EXPECT_EQ(told, 0) << "of " << draws;
}

/// The better a zero is known that was taken off, the better is G.
TEST(LawZeros, TheErrorOfAZeroThatWasTakenOffIsInTheInterval) {
  MaterialTest test = pulled(neo, VectorXd::Constant(1, 90e3), 0.0, 0.0, 20.0);
  double before = fit_law({test}, neo).fit.standard_errors(0);
  test.stress_zero_known = true;
  for (const double error : {300.0, 100.0, 30.0, 0.0}) {
    test.stress_zero_error = error;
    const LawFit fit = fit_law({test}, neo);
    EXPECT_LT(fit.fit.standard_errors(0), before) << error;
    EXPECT_NEAR(fit.fit.estimates(0), 90e3, 3.0 * fit.fit.standard_errors(0)) << error;
    before = fit.fit.standard_errors(0);
  }
}

/// Three specimens of 72, 90 and 112 kPa as tests of their own: none is wrong, they scatter; or
/// their rates tell them apart.
TEST(LawZeros, TestsOfOneWayThatDifferAreToldAsWhatTheyAre) {
  std::vector<MaterialTest> tests;
  for (const double g : {72e3, 90e3, 112e3}) {
    tests.push_back(pulled(neo, VectorXd::Constant(1, g), 0.0, 0.0, 200.0));
    tests.back().name = std::string(1, char('a' + int(tests.size()) - 1));
  }
  const auto told = [&] {
    std::string text;
    for (const std::string& sentence : fit_law(tests, neo).failed) text += sentence + '\n';
    return text;
  };
  EXPECT_NE(told().find(" Pa in b and 1.12e+05 Pa in c. Specimens that scatter are one test: path"),
            std::string::npos)
      << told();
  for (std::size_t t = 0; t < 3; ++t) tests[t].rate = 0.01 * std::pow(5.0, double(t));
  EXPECT_NE(told().find("Their rates differ 25 times, and G grows with them"), std::string::npos)
      << told();
  // A few per cent are no contradiction.
  for (std::size_t t = 0; t < 3; ++t) {
    const double g = 90e3 * (1.0 + 0.03 * (double(t) - 1.0));
    tests[t].stress = pulled(neo, VectorXd::Constant(1, g), 0.0, 0.0, 200.0).stress;
  }
  EXPECT_EQ(told(), "");
}

/// Three specimens of 72, 90 and 112 kPa: the interval is Student's of their mean.
TEST(LawZeros, TheScatterOfSpecimensIsInTheInterval) {
  MaterialTest test = pulled(neo, VectorXd::Constant(1, 91.33e3), 0.0, 0.0, 20.0);
  test.specimens = {72.0 / 91.33, 90.0 / 91.33, 112.0 / 91.33};
  const LawFit fit = fit_law({test}, neo);
  const double deviation = 20.03e3, half = 4.303 * deviation / std::sqrt(3.0);
  EXPECT_NEAR(fit.fit.estimates(0), 91.33e3, 50.0);
  EXPECT_NEAR(0.5 * (fit.fit.upper(0) - fit.fit.lower(0)), half, 0.05 * half);
}

/// Zeros, areas and noise drawn as they usually are.
TEST(LawPosterior, IntervalsHoldTheTruthAsOftenAsTheySay) {
  const Eigen::Vector2d rubber(10e3, 5e3);
  int held = 0, accepted = 0;
  constexpr int draws = 60;
  for (unsigned seed = 1; seed <= draws; ++seed) {
    std::mt19937 random(seed);
    std::vector<MaterialTest> tests;
    for (const double factor : {1.0 + 0.03 * normal(random), 1.0 + 0.03 * normal(random)}) {
      MaterialTest test = pulled(mooney, rubber, 0.0, 0.0025 * normal(random), 0.0, seed, 0.5);
      if (tests.empty()) {
        test.kind = TestKind::simple_shear;
        const SizedLaw law = sized_law(mooney, rubber);
        for (std::size_t i = 0; i < test.stress.size(); ++i) {
          const double shear = 0.01 * double(i + 1);
          test.deformation[i] = shear;
          test.stress[i] = test_stress(law, test.kind, test.measure, shear);
        }
      }
      const double most = test.stress.back(), zero = 0.005 * most * normal(random);
      for (double& stress : test.stress)
        stress = factor * stress + zero + 0.01 * most * normal(random);
      tests.push_back(test);
    }
    const LawFit fit = fit_law(tests, mooney);
    const ModulusOfLaws g = modulus_of(fit);
    accepted += fit.failed.empty() ? 1 : 0;
    held += g.lower <= 30e3 && 30e3 <= g.upper ? 1 : 0;
  }
  EXPECT_GE(held, 54);
  EXPECT_GE(accepted, 57);
}

/// A rubber that is 20 % stiffer in the second test, and plates that hold a column: the first is
/// told as a contradiction, the second with its cause. 8 % are what specimens differ by.
TEST(LawPosterior, FactorsBetweenTestsAreToldWithTheirCause) {
  const Eigen::Vector2d rubber(10e3, 5e3);
  MaterialTest pull = pulled(mooney, rubber, 0.0, 0.0, 200.0, 1, 0.5), push = pull;
  push.name = "pressed";
  std::mt19937 random(2);
  const SizedLaw law = sized_law(mooney, rubber);
  const auto told = [&](double factor) {
    for (std::size_t i = 0; i < push.stress.size(); ++i) {
      push.deformation[i] = 0.7 + 0.3 * double(i) / 46;
      push.stress[i] = factor * test_stress(law, push.kind, push.measure, push.deformation[i]) +
                       200.0 * normal(random);
    }
    std::string text;
    for (const std::string& sentence : fit_law({pull, push}, mooney).failed) text += sentence;
    return text;
  };
  EXPECT_EQ(told(1.0), "");
  EXPECT_EQ(told(1.08), "");
  const std::string stiffer = told(1.4), softer = told(0.6);
  EXPECT_NE(stiffer.find("tests contradict each other: pressed bears 1."), std::string::npos)
      << stiffer;
  EXPECT_NE(stiffer.find("plates hold the ends (friction)"), std::string::npos) << stiffer;
  EXPECT_NE(softer.find("Is it compressible (a foam)?"), std::string::npos) << softer;
  const std::vector<PartErrors> parts = fit_law({pull, push}, mooney).parts;
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_NEAR(parts[1].factor / parts[0].factor, 0.6, 0.03);
}

}  // namespace
