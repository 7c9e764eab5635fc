/// Which spacing keeps up with real time, from what short presses at a few of them took.
#pragma once

#include <cstddef>
#include <vector>

#include "lattice/press/press_setup.h"

namespace fingertip::studies::inline presses {

/// A press that may be taken, as coarse or fine as it is.
struct PaceCandidate {
  double spacing = 0.0;    ///< [m]
  double particles = 0.0;  ///< V/a³, of the part of the tip that is computed
  lattice::Integrator integrator = lattice::Integrator::symplectic_euler;
  double step = 0.0;  ///< [s]
  int threads = 1;

  /// Particles that a step moves; one of scaled masses takes as long as two plain ones.
  double load() const {
    return integrator == lattice::Integrator::mass_scaled ? 2.0 * particles : particles;
  }
};

/// What one of them did on this machine.
struct MeasuredPace {
  PaceCandidate candidate;
  double factor = 0.0;  ///< simulated over wall time in the slowest 10 ms, > 0
};

/// How many times as fast as real time a press must be expected to run to be taken: what a page's
/// pictures, a journal on the disk and other programs take comes on top of what was measured.
inline constexpr double pace_margin = 1.25;

/// Real-time factor to expect of a candidate: its own where it was measured, else from the time a
/// step takes, which grows with its load n as alpha + beta n: between measured ones along the line
/// through its neighbours, beyond the largest along the line through that and the next with the
/// same threads and at most half of its load, or in proportion to n where there is none or the line
/// falls. `measured` has one at least.
double expected_factor(const PaceCandidate& candidate, std::vector<MeasuredPace> measured);

struct PaceChoice {
  bool found = false;        ///< false: not even the coarsest keeps up, `index` is that one
  std::size_t index = 0;     ///< among the candidates
  double factor = 0.0;       ///< expected
  bool was_measured = true;  ///< else by the law above
};

/// The finest of `candidates` (coarsest first, one at least) that is expected to be pace_margin
/// times as fast as real time.
PaceChoice choose_pace(const std::vector<PaceCandidate>& candidates,
                       const std::vector<MeasuredPace>& measured);

/// Up to round-off.
bool same_spacing(double a, double b);

/// Where the choice of a step begins to look: a third of the depth [m]. Before, the grids that keep
/// up are themselves off by more than their steps.
double pace_judged_from(const lattice::PressSetup& setup);

/// Spacings from the coarsest that the finger's shape allows, R/n with n growing by an eighth, to
/// that of `asked`. Of each the integrator of `asked`, or, with `any_integrator`, scaled masses
/// where they serve with steps up to the control period, or a quarter of it under control, else
/// plain ones; the step that `asked` gives, else the longest that is stable and, of scaled masses,
/// keeps the force within lattice::tolerated_deviation from pace_judged_from() on; the threads that
/// `asked` gives, else those that are fastest.
std::vector<PaceCandidate> pace_candidates(const lattice::PressSetup& asked, bool any_integrator,
                                           int cores);

}  // namespace fingertip::studies::inline presses
