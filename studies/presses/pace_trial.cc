#include "studies/presses/pace_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "calibration/files/words.h"
#include "lattice/press/press.h"
#include "lattice/press/press_task.h"
#include "meshes/base/files.h"
#include "studies/jobs/interrupt.h"
#include "studies/presses/pace.h"
#include "studies/presses/press_setup.h"

namespace fingertip::studies::inline presses {

namespace {

using lattice::Integrator;
using lattice::PressOutcome;
using lattice::PressSetup;
using Moment = std::chrono::steady_clock::time_point;

constexpr double longest_trial = 0.3;  // of simulated time [s]
constexpr int max_trials = 10;

Moment moment_in(double seconds) {
  using SteadyClock = std::chrono::steady_clock;
  return SteadyClock::now() +
         std::chrono::duration_cast<SteadyClock::duration>(std::chrono::duration<double>(seconds));
}

double seconds_until(Moment moment) {
  return std::chrono::duration<double>(moment - std::chrono::steady_clock::now()).count();
}

/// Prescribed, so that neither a controller's answers nor its trouble with another speed are in it;
/// of the part of the tip that the press itself computes.
PressSetup trial_of(PressSetup setup) {
  setup.symmetry = lattice::moving_sectors(setup) > 1;
  meshes::PressProtocol& protocol = setup.protocol;
  protocol.mode = meshes::DriveMode::quasi_static;
  for (const meshes::PressStage& stage : protocol.program)
    protocol.speed = std::max(protocol.speed, stage.speed);
  protocol.program.clear();
  protocol.speed = std::max(protocol.speed, (protocol.clearance + protocol.depth) / longest_trial);
  setup.make_controller = {};
  setup.controller_identity.clear();
  setup.follows_path = true;
  setup.duration.reset();
  return setup;
}

/// In the slowest 10 ms; as a whole where the press did not get so far.
double factor_of(const PressOutcome& outcome, double period) {
  const double slowest = slowest_pace(outcome, pace_window).wall;
  if (std::isfinite(slowest)) return slowest;
  return std::max(outcome.trace.back().time, period) / outcome.elapsed.back().wall;
}

double run_trial(const PressSetup& setup, Moment end) {
  double cut_off = 0.0;
  const auto observe = [&](const PressOutcome& so_far, double) {
    if (seconds_until(end) > 0.0 && !interrupted()) return true;
    cut_off = factor_of(so_far, setup.controller.period);
    return false;
  };
  try {
    return factor_of(lattice::run_press(setup, observe), setup.controller.period);
  } catch (const meshes::Interrupted&) {
    if (interrupted()) throw;
    return cut_off;
  }
}

}  // namespace

double measured_factor(const PressSetup& setup, double seconds) {
  const PressSetup trial = trial_of(setup);
  const Moment end = moment_in(seconds);
  double best = run_trial(trial, end);
  for (int i = 1; i < max_trials && seconds_until(end) > 0.5 * seconds; ++i)
    best = std::max(best, run_trial(trial, end));
  return best;
}

PaceSearch search_pace(std::vector<PaceCandidate> candidates, double seconds,
                       const std::function<double(const PaceCandidate&, double)>& measure) {
  constexpr double half_as_fine = 1.5, share = 0.25, too_short = 0.1;
  const Moment end = moment_in(seconds);
  PaceSearch search;
  search.candidates = std::move(candidates);
  const auto add = [&](const PaceCandidate& candidate, double longest) {
    search.measured.push_back({candidate, measure(candidate, longest)});
    search.choice = choose_pace(search.candidates, search.measured);
  };
  const PaceCandidate& coarsest = search.candidates.front();
  add(coarsest, share * seconds);
  if (!search.choice.found) return search;
  const auto second = std::ranges::find_if(search.candidates, [&](const PaceCandidate& candidate) {
    return candidate.spacing * half_as_fine <= coarsest.spacing * (1.0 + 1e-9);
  });
  if (second != search.candidates.end()) add(*second, share * seconds);
  while (!search.choice.was_measured && seconds_until(end) > too_short)
    add(search.taken(), seconds_until(end));
  return search;
}

LoadedConfig with_any_integrator(const LoadedConfig& asked) {
  return asked.entries.at("run.integrator").given ? asked
                                                  : with_sets(asked, {"run.integrator=auto"});
}

std::vector<std::string> settings_of(const PaceCandidate& taken, const LoadedConfig& asked) {
  std::vector<std::string> sets;
  const double spacing = asked.config.press.lattice.spacing;
  if (taken.spacing > spacing * (1.0 + 1e-9)) {
    const double n = asked.config.press.geometry.tip_radius / taken.spacing;
    sets.push_back("lattice.spacing=tip_radius/" + calibration::rounded(n, 12));
  }
  if (asked.config.automatic_integrator)
    sets.push_back(fmt::format("run.integrator={}", lattice::name(taken.integrator)));
  if (!asked.config.press.time_step && taken.integrator == Integrator::mass_scaled)
    sets.push_back("run.time_step=" + meshes::to_text(taken.step) + " s");
  return sets;
}

PaceSearch search_pace_here(const LoadedConfig& asked, int cores, bool any_depth) {
  const PressSetup setup = press_setup(with_material(asked, LatticeUse::press));
  const auto measure = [&](const PaceCandidate& candidate, double seconds) {
    PressSetup press = press_setup(
        with_material(with_sets(asked, settings_of(candidate, asked)), LatticeUse::press));
    press.threads = candidate.threads;
    constexpr double hardly = 1e-3;
    try {
      return measured_factor(press, seconds);
    } catch (const meshes::NotConverged&) {
      if (!any_depth) throw;
      return hardly;
    }
  };
  return search_pace(pace_candidates(setup, asked.config.automatic_integrator, cores),
                     pace_search_time, measure);
}

}  // namespace fingertip::studies::inline presses
