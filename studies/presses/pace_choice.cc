#include "studies/presses/pace_choice.h"

#include <algorithm>
#include <cmath>

#include "lattice/dynamics/thread_choice.h"
#include "lattice/press/press_deviation.h"
#include "lattice/press/press_task.h"

namespace fingertip::studies::inline presses {

namespace {

using lattice::Integrator;
using lattice::PressSetup;

/// Wall time of a step [s].
double step_cost(const MeasuredPace& pace) {
  return pace.candidate.step / pace.factor;
}

/// Beyond the largest of `measured` [s]. Two of much the same load make no line: what disturbed
/// them would be most of its slope.
double extended_cost(const std::vector<MeasuredPace>& measured, double load) {
  constexpr double apart = 2.0;
  const MeasuredPace& large = measured.back();
  const double cost = step_cost(large), last = large.candidate.load();
  double slope = cost / last;  // no fixed time
  for (const MeasuredPace& small : measured) {
    if (small.candidate.threads != large.candidate.threads || apart * small.candidate.load() > last)
      continue;
    const double line = (cost - step_cost(small)) / (last - small.candidate.load());
    if (line > 0.0) slope = line;
  }
  return cost + slope * (load - last);
}

/// Wall time of a step of that load; `measured` by increasing load.
double expected_cost(const std::vector<MeasuredPace>& measured, double load) {
  const auto larger = std::ranges::find_if(
      measured, [&](const MeasuredPace& m) { return m.candidate.load() > load; });
  // Less than anything that was pressed: no faster than the least of that.
  if (larger == measured.begin()) return step_cost(*larger);
  if (larger == measured.end()) return extended_cost(measured, load);
  const MeasuredPace& smaller = *(larger - 1);
  const double part =
      (load - smaller.candidate.load()) / (larger->candidate.load() - smaller.candidate.load());
  return (1.0 - part) * step_cost(smaller) + part * step_cost(*larger);
}

/// Of scaled masses whole steps make a control period.
double divided(double period, double step) {
  return period / std::ceil(period / step * (1.0 - 1e-9));
}

/// A rod under control sways, and in steps as long as the period without end.
double longest_step(const PressSetup& setup) {
  const bool controlled = setup.protocol.mode == meshes::DriveMode::pid;
  return (controlled ? 0.25 : 1.0) * setup.controller.period;
}

PaceCandidate candidate_at(const PressSetup& setup, bool scalable) {
  PaceCandidate candidate;
  candidate.spacing = setup.lattice.spacing;
  candidate.particles = lattice::moving_particles(setup);
  candidate.integrator = setup.integrator;
  const double period = setup.controller.period;
  if (scalable && !setup.time_step) {
    const lattice::ScalingChoice scaling =
        lattice::best_scaling(setup, longest_step(setup), pace_judged_from(setup));
    candidate.integrator = scaling.scaled ? Integrator::mass_scaled : Integrator::symplectic_euler;
    if (scaling.scaled) candidate.step = divided(period, scaling.step);
  }
  if (setup.time_step) candidate.step = divided(period, *setup.time_step);
  if (candidate.step == 0.0) candidate.step = std::fmin(lattice::plain_step(setup), period);
  return candidate;
}

}  // namespace

bool same_spacing(double a, double b) {
  return std::abs(a - b) <= 1e-9 * b;
}

double pace_judged_from(const PressSetup& setup) {
  constexpr double round_off = 1e-9;
  return setup.protocol.depth / 3.0 * (1.0 - round_off);
}

double expected_factor(const PaceCandidate& candidate, std::vector<MeasuredPace> measured) {
  for (const MeasuredPace& own : measured)
    if (same_spacing(own.candidate.spacing, candidate.spacing)) return own.factor;
  std::ranges::sort(measured, {}, [](const MeasuredPace& m) { return m.candidate.load(); });
  return candidate.step / expected_cost(measured, candidate.load());
}

PaceChoice choose_pace(const std::vector<PaceCandidate>& candidates,
                       const std::vector<MeasuredPace>& measured) {
  PaceChoice choice;
  for (std::size_t i = candidates.size(); i-- > 0 && !choice.found;) {
    const double factor = expected_factor(candidates[i], measured);
    choice = {factor >= pace_margin, i, factor,
              std::ranges::any_of(measured, [&](const MeasuredPace& m) {
                return same_spacing(m.candidate.spacing, candidates[i].spacing);
              })};
  }
  return choice;
}

std::vector<PaceCandidate> pace_candidates(const PressSetup& asked, bool any_integrator,
                                           int cores) {
  constexpr double growth = 1.125, round_off = 1e-9;
  PressSetup scaled = asked;
  scaled.integrator = Integrator::mass_scaled;
  const bool scalable =
      any_integrator ? scaled.violations().empty() : asked.integrator == Integrator::mass_scaled;
  const double radius = asked.geometry.tip_radius, finest = asked.lattice.spacing;
  std::vector<PaceCandidate> candidates;
  const auto add = [&](double spacing) {
    PressSetup setup = asked;
    setup.lattice.spacing = spacing;
    PaceCandidate& made = candidates.emplace_back(candidate_at(setup, scalable));
    made.threads =
        asked.threads > 0 ? asked.threads : lattice::fastest_threads(made.particles, cores);
  };
  double n = std::ceil(radius / asked.geometry.coarsest_spacing() * (1.0 - round_off));
  for (; radius / n > finest * (1.0 + round_off); n = std::max(n + 1.0, std::round(growth * n)))
    add(radius / n);
  add(finest);
  return candidates;
}

}  // namespace fingertip::studies::inline presses
