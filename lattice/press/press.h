/// The press: rod, tip and plane in time, under a controller or with prescribed motion.
#pragma once

#include <functional>

#include "lattice/press/press_outcome.h"
#include "lattice/press/press_setup.h"

namespace fingertip::lattice::inline press {

/// Called about ten times a second of wall time and at every sample. Returning false ends the run
/// with Interrupted after the observer has seen the outcome so far.
using PressObserver = std::function<bool(const PressOutcome& so_far, double fraction_done)>;

/// Runs the press, until its depth is reached or its program ends. Throws InvalidInput for a setup
/// that breaks a rule or a time step above the stability bound (with the reason), NotConverged when
/// the lattice blows up (the observer has seen what was finished), ControllerFailed likewise,
/// Interrupted when the observer asks.
PressOutcome run_press(const PressSetup& setup, const PressObserver& observer = {},
                       const PressFilm& film = {});

}  // namespace fingertip::lattice::inline press
