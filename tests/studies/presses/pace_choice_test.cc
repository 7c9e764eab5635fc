// Which spacing keeps up, as a function of what was measured: no machine's speed is in it.
#include "studies/presses/pace_choice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "lattice/dynamics/thread_choice.h"
#include "lattice/press/press_deviation.h"
#include "studies/presses/pace_trial.h"
#include "tests/studies/configured.h"

using namespace fingertip;
using namespace fingertip::studies;
using lattice::Integrator;

namespace {

constexpr double step = 2.5e-4;

/// R/n of a specimen of 2.5 R³.
PaceCandidate candidate(int n, int threads = 1) {
  return {0.01 / n, 2.5 * std::pow(n, 3), Integrator::mass_scaled, step, threads};
}

std::vector<PaceCandidate> candidates(int finest) {
  std::vector<PaceCandidate> all;
  for (int n = 4; n <= finest; ++n) all.push_back(candidate(n));
  return all;
}

/// A machine on which a step takes so long [s].
struct Machine {
  double fixed = 2e-6, per_load = 4e-9;
  double factor(const PaceCandidate& press) const {
    return press.step / (fixed + per_load * press.load());
  }
  MeasuredPace measured(const PaceCandidate& press) const { return {press, factor(press)}; }
};

}  // namespace

TEST(PaceChoice, AStepTakesAFixedTimeAndOnePerParticle) {
  const Machine machine;
  const std::vector<MeasuredPace> two = {machine.measured(candidate(6)),
                                         machine.measured(candidate(4))};
  for (const int n : {5, 9, 24})
    EXPECT_NEAR(expected_factor(candidate(n), two) / machine.factor(candidate(n)), 1.0, 1e-12) << n;
}

TEST(PaceChoice, ItsOwnMeasurementCountsMoreThanTheLaw) {
  const Machine machine;
  const std::vector<MeasuredPace> known = {
      machine.measured(candidate(4)), {candidate(6), 0.123}, machine.measured(candidate(8))};
  EXPECT_EQ(expected_factor(candidate(6), known), 0.123);
}

TEST(PaceChoice, AScaledStepMovesTwiceAsManyParticlesAsAPlainOne) {
  PaceCandidate plain = candidate(8);
  plain.integrator = Integrator::symplectic_euler;
  EXPECT_EQ(candidate(8).load(), 2.0 * plain.load());
}

TEST(PaceChoice, WhatOtherThreadsTookIsNotExtended) {
  const Machine machine;
  const MeasuredPace alone = machine.measured(candidate(4));
  // On two threads half the time: a line through both would promise steps that cost nothing.
  const MeasuredPace shared = {candidate(8, 2), 2.0 * machine.factor(candidate(8))};
  const double expected = expected_factor(candidate(16, 2), {alone, shared});
  EXPECT_NEAR(expected, shared.factor / 8.0, 1e-12);
}

TEST(PaceChoice, ALineThatFallsIsNotBelieved) {
  const std::vector<MeasuredPace> disturbed = {{candidate(4), 1.0}, {candidate(6), 4.0}};
  EXPECT_NEAR(expected_factor(candidate(12), disturbed), 4.0 / 8.0, 1e-12);
}

TEST(PaceChoice, TwoOfMuchTheSameLoadMakeNoLine) {
  // R/12 took hardly longer than R/11: R/24 is not for free because of that.
  const std::vector<MeasuredPace> close = {{candidate(11, 2), 2.51}, {candidate(12, 2), 2.5}};
  EXPECT_NEAR(expected_factor(candidate(24, 2), close), 2.5 / 8.0, 1e-12);
}

TEST(PaceChoice, TheFinestThatKeepsUpIsTaken) {
  const auto all = candidates(24);
  for (double speed = 1e-3; speed < 1e3; speed *= 1.3) {
    const Machine machine{2e-6 / speed, 4e-9 / speed};
    const PaceChoice choice =
        choose_pace(all, {machine.measured(all[0]), machine.measured(all[2])});
    const bool keeps_up = machine.factor(all[0]) >= pace_margin;
    EXPECT_EQ(choice.found, keeps_up) << speed;
    EXPECT_NEAR(choice.factor / machine.factor(all[choice.index]), 1.0, 1e-12);
    if (!keeps_up) {
      EXPECT_EQ(choice.index, 0u) << "the figure of the coarsest is told";
    } else if (choice.index + 1 < all.size()) {
      EXPECT_LT(machine.factor(all[choice.index + 1]), pace_margin) << speed;
    }
  }
}

TEST(PaceSearch, EndsWithALatticeThatWasTriedItself) {
  // Beyond R/9 the lattice leaves the cache: the law of coarse lattices promises too much.
  const auto cliff = [](const PaceCandidate& press) {
    return Machine{}.factor(press) / (press.spacing < 0.01 / 9.5 ? 8.0 : 1.0);
  };
  std::map<double, int> tries;
  const PaceSearch search =
      search_pace(candidates(24), 1e9, [&](const PaceCandidate& press, double seconds) {
        EXPECT_GT(seconds, 0.0);
        ++tries[press.spacing];
        return cliff(press);
      });
  EXPECT_TRUE(search.choice.found);
  EXPECT_TRUE(search.choice.was_measured);
  EXPECT_GE(cliff(search.taken()), pace_margin);
  for (const auto& [spacing, times] : tries) EXPECT_EQ(times, 1) << spacing;
  EXPECT_EQ(search.measured[0].candidate.spacing, 0.01 / 4);
  EXPECT_EQ(search.measured[1].candidate.spacing, 0.01 / 6);
}

TEST(PaceSearch, WithoutTimeTheLawDecides) {
  const Machine machine;
  const PaceSearch search =
      search_pace(candidates(40), 0.0,
                  [&](const PaceCandidate& press, double) { return machine.factor(press); });
  EXPECT_EQ(search.measured.size(), 2u);
  EXPECT_TRUE(search.choice.found);
  EXPECT_FALSE(search.choice.was_measured);
  EXPECT_GE(machine.factor(search.taken()), pace_margin);
}

TEST(PaceSearch, AMachineThatIsTooSlowIsTriedOnce) {
  const PaceSearch search =
      search_pace(candidates(12), 1e9, [](const PaceCandidate&, double) { return 0.4; });
  EXPECT_FALSE(search.choice.found);
  EXPECT_EQ(search.choice.index, 0u);
  EXPECT_EQ(search.choice.factor, 0.4);
  EXPECT_EQ(search.measured.size(), 1u);
}

TEST(PaceCandidates, GoFromTheCoarsestLatticeToTheOneThatWasAsked) {
  const LoadedConfig asked = config_of({"lattice.spacing=tip_radius/15.5"});
  const auto setup = press_setup(asked);
  const auto found = pace_candidates(setup, true, 2);
  EXPECT_EQ(found.front().spacing, setup.geometry.coarsest_spacing());
  EXPECT_EQ(found.back().spacing, setup.lattice.spacing);
  for (std::size_t i = 1; i < found.size(); ++i) {
    EXPECT_LT(found[i].spacing, found[i - 1].spacing);
    EXPECT_GT(found[i].spacing, found[i - 1].spacing / 1.3);
  }
}

TEST(PaceCandidates, StepsKeepTheForceAndAreAsLongAsThat) {
  const LoadedConfig asked =
      config_of({"lattice.spacing=tip_radius/24", "press.mode=quasi-static"});
  auto setup = press_setup(asked);
  bool scaled = false;
  for (const PaceCandidate& press : pace_candidates(setup, true, 2)) {
    setup.lattice.spacing = press.spacing;
    const auto worst = [&](double at) {
      return lattice::worst_of(lattice::scaling_deviations(setup, at), pace_judged_from(setup))
          .relative;
    };
    if (press.integrator == Integrator::symplectic_euler) {
      EXPECT_EQ(press.step, lattice::plain_step(setup));
      continue;
    }
    scaled = true;
    EXPECT_LE(worst(press.step), lattice::tolerated_deviation);
    const double steps = setup.controller.period / press.step;
    EXPECT_NEAR(steps, std::round(steps), 1e-9) << "whole steps make a period";
    if (steps > 1.5) {
      EXPECT_GT(worst(setup.controller.period / (std::round(steps) - 1.0)) * 1.3,
                lattice::tolerated_deviation)
          << "one step less in a period would do, too";
    }
  }
  EXPECT_TRUE(scaled);
}

TEST(PaceCandidates, StepsUnderControlAreAQuarterOfItsPeriodAtMost) {
  const auto setup = press_setup(config_of({"lattice.spacing=tip_radius/12"}));
  bool longest = false;
  for (const PaceCandidate& press : pace_candidates(setup, true, 2)) {
    if (press.integrator != Integrator::mass_scaled) continue;
    EXPECT_LE(press.step, 0.25 * setup.controller.period * (1.0 + 1e-9));
    longest = longest || press.step > 0.24 * setup.controller.period;
  }
  EXPECT_TRUE(longest);
}

TEST(PaceCandidates, WhatIsGivenStays) {
  const auto given = press_setup(config_of({"run.integrator=mass-scaled", "run.time_step=0.5 ms"}));
  for (const PaceCandidate& press : pace_candidates(given, false, 2)) {
    EXPECT_EQ(press.integrator, Integrator::mass_scaled);
    EXPECT_NEAR(press.step, 5e-4, 1e-15);
  }
  const auto plain = press_setup(config_of({"run.threads=3"}));
  for (const PaceCandidate& press : pace_candidates(plain, false, 8)) {
    EXPECT_EQ(press.integrator, Integrator::symplectic_euler);
    EXPECT_EQ(press.threads, 3);
  }
  // Springs alone cannot be scaled.
  for (const PaceCandidate& press :
       pace_candidates(press_setup(config_of({"lattice.model=published"})), true, 2))
    EXPECT_EQ(press.integrator, Integrator::symplectic_euler);
}

TEST(PaceCandidates, TheirSettingsMakeTheirPress) {
  const LoadedConfig asked = with_any_integrator(config_of({"press.contact=stick"}));
  const auto setup = press_setup(asked);
  for (const PaceCandidate& press : pace_candidates(setup, true, 1)) {
    const auto made = press_setup(with_sets(asked, settings_of(press, asked)));
    EXPECT_NEAR(made.lattice.spacing / press.spacing, 1.0, 1e-11);
    EXPECT_EQ(made.integrator, press.integrator);
    EXPECT_EQ(made.time_step.has_value(), press.integrator == Integrator::mass_scaled);
    if (made.time_step) {
      EXPECT_EQ(*made.time_step, press.step);
    }
  }
}

TEST(ThreadChoice, GrowsWithTheLatticeUpToTheCores) {
  EXPECT_EQ(lattice::fastest_threads(10.0, 8), 1);
  EXPECT_EQ(lattice::fastest_threads(1e7, 8), 8);
  EXPECT_EQ(lattice::fastest_threads(1e7, 1), 1);
  int last = 1;
  for (double particles = 10.0; particles < 1e7; particles *= 1.1) {
    const int threads = lattice::fastest_threads(particles, 64);
    EXPECT_GE(threads, last);
    EXPECT_LE(double(threads - 1) * lattice::particles_per_thread, particles);
    last = threads;
  }
}
