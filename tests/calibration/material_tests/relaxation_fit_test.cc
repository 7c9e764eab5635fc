/// Fits of a relaxation beside a law: recovery, number of branches, what stays open.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "calibration/material_tests/law_fit.h"
#include "meshes/base/errors.h"
#include "tests/expectations.h"

using namespace fingertip;
using namespace fingertip::calibration;
using Eigen::VectorXd;
using meshes::RubberLaw;

namespace {

VectorXd list_of(std::initializer_list<double> values) {
  return VectorXd::Map(values.begin(), Eigen::Index(values.size()));
}

/// Uniform of deviation 1.
double noise(std::mt19937& random) {
  return std::sqrt(12.0) * (double(random()) / double(std::mt19937::max()) - 0.5);
}

const LawChoice yeoh_two{RubberLaw::yeoh, 2, 2};
const VectorXd truth = list_of({10e3, 400.0, 0.15, 0.08, 0.2, 6.0});

/// With a relative noise.
void fill(MaterialTest& test, const LawChoice& choice, const VectorXd& law, double relative,
          unsigned seed) {
  std::mt19937 random(seed);
  const std::size_t n = test.deformation.size();
  const VectorXd stress =
      LawModel(test, std::vector<double>(n, 1.0), choice, coefficients(choice)).evaluate(law).value;
  const double size = stress.norm() / std::sqrt(double(n));
  test.stress.clear();
  for (const double value : stress) test.stress.push_back(value + relative * size * noise(random));
}

MaterialTest ramp_and_hold(double ramp, double last, double stretch, double relative = 0.0,
                           const LawChoice& choice = yeoh_two, const VectorXd& law = truth) {
  MaterialTest test;
  test.name = "relaxation";
  test.course = TestCourse::relaxation;
  test.path = {{0.0, ramp, last}, {1.0, stretch, stretch}};
  for (int i = 0; i < 120; ++i)
    test.time.push_back(0.2 * ramp * std::pow(5.0 * last / ramp, double(i) / 119));
  test.time.back() = last;
  for (const double time : test.time) test.deformation.push_back(test.path.at(time));
  fill(test, choice, law, relative, 3);
  return test;
}

MaterialTest cycled(double period, int cycles, double relative = 0.0,
                    const LawChoice& choice = yeoh_two, const VectorXd& law = truth) {
  MaterialTest test;
  test.name = "cycles";
  test.course = TestCourse::cycles;
  test.kind = TestKind::planar;
  test.path = {{0.0}, {1.0}};
  for (int i = 1; i <= 40 * cycles; ++i) {
    const double time = period * i / 40, phase = time / period - std::floor(time / period);
    test.path.time.push_back(time);
    test.path.deformation.push_back(1.0 + 1.6 * std::min(phase, 1.0 - phase));
    test.time.push_back(time);
    test.deformation.push_back(test.path.deformation.back());
  }
  fill(test, choice, law, relative, 7);
  return test;
}

MaterialTest stretched(std::optional<double> rate, double relative = 0.0) {
  MaterialTest test;
  test.name = "tension";
  for (int i = 1; i <= 30; ++i) test.deformation.push_back(1.0 + 0.05 * i);
  test.stress.assign(30, 1.0);
  test.rate = rate;
  fill(test, yeoh_two, truth, relative, 11);
  return test;
}

TEST(RelaxationFit, RecoversLawAndBranchesFromExactStresses) {
  const LawFit fit =
      fit_law({ramp_and_hold(0.05, 60.0, 1.5), cycled(2.0, 4), stretched(0.01)}, yeoh_two);
  ASSERT_EQ(fit.fit.estimates.size(), truth.size());
  for (Eigen::Index i = 0; i < truth.size(); ++i)
    EXPECT_NEAR(fit.fit.estimates(i), truth(i), 1e-5 * truth(i)) << i;
  EXPECT_TRUE(fit.open_branches.empty());
  EXPECT_NEAR(fit.relaxation.branches[1].time, 6.0, 1e-4);
  // 23 stresses of the ramp, the last at 0.05 s: their mean step.
  EXPECT_NEAR((*fit.times)[0], 0.05 / 23, 1e-5);
  EXPECT_NEAR((*fit.times)[1], 60.0, 1e-12);
  EXPECT_NEAR(fit.fitted[1].loop_computed, fit.fitted[1].loop_measured,
              1e-4 * fit.fitted[1].loop_measured);
  EXPECT_GT(fit.fitted[1].loop_measured, 0.0);
}

/// The number of branches that there are has the least AICc, and intervals hold the truth.
TEST(RelaxationFit, RanksBranchesAndHoldsTheTruth) {
  const std::vector<MaterialTest> tests = {ramp_and_hold(0.05, 60.0, 1.5, 0.01),
                                           cycled(2.0, 4, 0.01)};
  std::vector<LawChoice> choices;
  for (const RubberLaw law : {RubberLaw::neo_hookean, RubberLaw::yeoh})
    for (int branches = 0; branches <= 3; ++branches)
      choices.push_back({law, law == RubberLaw::yeoh ? 2 : 1, branches});
  const auto ranking = rank_laws(tests, {stretched(0.01)}, choices);
  const LawFit* best = recommended(ranking);
  ASSERT_NE(best, nullptr);
  EXPECT_EQ(name(best->choice), "yeoh-2+prony-2");
  EXPECT_LT(best->predicted[0].rms_relative, 0.01);
  int inside = 0;
  for (Eigen::Index i = 0; i < truth.size(); ++i)
    if (best->fit.lower(i) < truth(i) && best->fit.upper(i) > truth(i)) ++inside;
  EXPECT_GE(inside, 5);
  // More branches are never worse.
  const auto squares = [&](int branches) {
    for (const LawFit& fit : ranking)
      if (fit.choice == LawChoice{RubberLaw::yeoh, 2, branches})
        return fit.fitted[0].sum_of_squares /
                   std::pow(fit.fitted[0].rms / fit.fitted[0].rms_relative, 2) +
               fit.fitted[1].sum_of_squares /
                   std::pow(fit.fitted[1].rms / fit.fitted[1].rms_relative, 2);
    return 0.0;
  };
  for (int branches = 1; branches <= 3; ++branches)
    EXPECT_LE(squares(branches), squares(branches - 1) * (1.0 + 1e-6)) << branches;
}

TEST(RelaxationFit, TellsBranchesThatTheTestsDoNotReach) {
  const LawChoice one{RubberLaw::neo_hookean, 1, 1};
  const auto opened = [&](double tau) {
    const VectorXd law = list_of({10e3, 0.3, tau});
    return fit_law({ramp_and_hold(0.05, 60.0, 1.3, 0.001, one, law)}, one);
  };
  EXPECT_TRUE(opened(2.0).open_branches.empty());
  const LawFit slow = opened(200.0), fast = opened(0.001);
  ASSERT_EQ(slow.open_branches.size(), 1u);
  EXPECT_TRUE(
      says(slow.open_branches[0], {"slower than what the data tell, up to 60 s", "a hold of"}));
  ASSERT_EQ(fast.open_branches.size(), 1u);
  EXPECT_TRUE(says(fast.open_branches[0], "faster than what the data tell, from 0.00217 s on"));
}

/// A slow ramp to the stretch 4, measured every half second, and a hold: the fastest branch shows
/// in the rows of the ramp alone, where the times told began at its end. The search for three
/// branches ends at a bound of the slowest time, from which it is not to begin an ulp beyond.
TEST(RelaxationFit, ARampThatIsMeasuredTellsOfFastBranches) {
  const VectorXd rubber = list_of({12.5e3, 0.56, 0.8, 0.25, 8.0, 0.08, 80.0});
  const LawChoice made{RubberLaw::neo_hookean, 1, 3};
  MaterialTest test;
  test.name = "ramp and hold";
  test.course = TestCourse::relaxation;
  test.path = {{0.0, 12.0, 400.0}, {1.0, 4.0, 4.0}};
  for (int i = 1; i <= 800; ++i) test.time.push_back(0.5 * i);
  for (const double time : test.time) test.deformation.push_back(test.path.at(time));
  fill(test, made, rubber, 0.0, 1);
  EXPECT_NEAR(observed_times(test)[0], 0.5, 1e-12);
  std::vector<LawChoice> laws;
  for (const LawChoice& law : known_laws())
    for (int branches = 0; branches <= 3; ++branches)
      if (law.terms < 3) laws.push_back({law.law, law.terms, branches});
  const auto ranking = rank_laws({test}, {}, laws);
  for (const LawFit& fit : ranking)
    ASSERT_TRUE(fit.failure.empty()) << name(fit.choice) << ": " << fit.failure;
  const auto found = [&](RubberLaw law, int terms, int branches) -> const LawFit& {
    return *std::ranges::find(ranking, LawChoice{law, terms, branches}, &LawFit::choice);
  };
  // Over all squares of stress; some laws reach others at an end of their range alone.
  const auto misfit = [](const LawFit& fit) { return std::pow(fit.fitted[0].rms_relative, 2); };
  using enum RubberLaw;
  for (int branches = 0; branches <= 3; ++branches)
    for (const auto& [general, special] : {std::pair(std::pair(yeoh, 2), std::pair(neo_hookean, 1)),
                                           {{mooney_rivlin, 1}, {neo_hookean, 1}},
                                           {{gent, 1}, {neo_hookean, 1}},
                                           {{ogden, 1}, {neo_hookean, 1}},
                                           {{ogden, 2}, {ogden, 1}},
                                           {{ogden, 2}, {mooney_rivlin, 1}}}) {
      const LawFit& one = found(special.first, special.second, branches);
      // Ogden's terms are positive.
      if (special.first == mooney_rivlin && one.fit.estimates.head(2).minCoeff() < 0.0) continue;
      EXPECT_LE(misfit(found(general.first, general.second, branches)),
                misfit(one) * (1.0 + 1e-3) + 1e-9)
          << name(LawChoice{general.first, general.second, branches}) << " and "
          << name(one.choice);
    }
  const LawFit* best = recommended(ranking);
  ASSERT_NE(best, nullptr);
  EXPECT_EQ(name(best->choice), "neo-hookean+prony-3");
  EXPECT_TRUE(best->failed.empty()) << best->failed.front();
  for (Eigen::Index i = 0; i < rubber.size() && best->fit.estimates.size() == rubber.size(); ++i)
    EXPECT_NEAR(best->fit.estimates(i), rubber(i), 1e-3 * rubber(i)) << i;
}

/// Noise of 0.05 % prefers a law of a coefficient too many in some of its drawings, by up to 5 of
/// AICc: what is as good and simpler is taken.
TEST(RelaxationFit, NoiseDoesNotChooseAMoreGeneralLaw) {
  const LawChoice made{RubberLaw::neo_hookean, 1, 3};
  MaterialTest test;
  test.name = "ramp and hold";
  test.course = TestCourse::relaxation;
  test.path = {{0.0, 12.0, 400.0}, {1.0, 4.0, 4.0}};
  for (int i = 1; i <= 800; ++i) test.time.push_back(0.5 * i);
  for (const double time : test.time) test.deformation.push_back(test.path.at(time));
  bool preferred = false;
  for (const unsigned seed : {1U, 2U, 3U}) {
    fill(test, made, list_of({12.5e3, 0.56, 0.8, 0.25, 8.0, 0.08, 80.0}), 0.0005, seed);
    using enum RubberLaw;
    const auto ranking = rank_laws(
        {test}, {}, {made, {yeoh, 2, 3}, {yeoh, 3, 3}, {mooney_rivlin, 1, 3}, {ogden, 1, 3}});
    preferred = preferred || ranking.front().choice != made;
    const LawFit* best = recommended(ranking);
    ASSERT_NE(best, nullptr);
    EXPECT_EQ(name(best->choice), "neo-hookean+prony-3") << seed;
  }
  EXPECT_TRUE(preferred) << "else there is nothing to see";
}

/// Cycles of a rubber that does not relax, and a law that makes no loop of cycles that have one.
TEST(RelaxationFit, LoopsThatAreMissedContradict) {
  const auto ranking = rank_laws({cycled(2.0, 3)}, {}, {{RubberLaw::yeoh, 2, 0}});
  bool told = false;
  for (const std::string& sentence : ranking[0].contradictions)
    told = told || sentence.find("the loops of cycles hold") != std::string::npos;
  EXPECT_TRUE(told);
}

TEST(RelaxationFit, NeedsATestInTime) {
  EXPECT_THROW(fit_law({stretched(0.1)}, yeoh_two), meshes::InvalidInput);
  EXPECT_EQ(law_named("yeoh-2+prony-2"), yeoh_two);
  EXPECT_FALSE(law_named("yeoh-2+prony-9"));
  EXPECT_FALSE(law_named("yeoh-2+prony-0"));
}

}  // namespace
