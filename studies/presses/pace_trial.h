/// Short presses that tell how fast this machine is, and the spacing that comes of them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "studies/config/loader.h"
#include "studies/presses/pace_choice.h"

namespace fingertip::studies::inline presses {

/// Real-time factor in the slowest 10 ms from the first touch on, of the best of up to ten presses
/// of `setup` that begin within half of `seconds` of wall time (others at work slow single ones);
/// after `seconds` a press is cut off. The rod moves as prescribed, at press.speed, or faster so
/// that a press takes 0.3 s of simulated time; a program is one press to its depth. Throws
/// NotConverged, Interrupted, InvalidInput.
double measured_factor(const lattice::PressSetup& setup, double seconds);

struct PaceSearch {
  std::vector<PaceCandidate> candidates;  ///< coarsest first; the last is what was asked for
  std::vector<MeasuredPace> measured;     ///< as they came
  PaceChoice choice;

  const PaceCandidate& taken() const { return candidates[choice.index]; }
  const PaceCandidate& asked() const { return candidates.back(); }
};

/// Measures the coarsest candidate and one half as fine again, then what choose_pace makes of them,
/// until that was measured itself or `seconds` are over. `measure` presses a candidate within the
/// time it is given and tells its factor, > 0.
PaceSearch search_pace(
    std::vector<PaceCandidate> candidates, double seconds,
    const std::function<double(const PaceCandidate& candidate, double seconds)>& measure);

/// Longest time that a search on this machine takes, but for building the lattices [s].
inline constexpr double pace_search_time = 2.0;

/// Where an integrator is not given, run.integrator = auto.
LoadedConfig with_any_integrator(const LoadedConfig& asked);

/// What --set has to say beside `asked` to press `taken`; a spacing as asked, threads and plain
/// steps are not told.
std::vector<std::string> settings_of(const PaceCandidate& taken, const LoadedConfig& asked);

/// The search on this machine with presses of `asked` on up to `cores` cores. Throws as
/// measured_factor; but a press that does not converge is, with `any_depth`, one that does not keep
/// up: who decides on the depth later may press less.
PaceSearch search_pace_here(const LoadedConfig& asked, int cores, bool any_depth = false);

}  // namespace fingertip::studies::inline presses
