/// What is said about a press before it is run.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lattice/press/press_setup.h"

namespace fingertip::studies::inline presses {

/// That a law of large strain has no say where the lattice knows E and G alone.
std::vector<std::string> law_notes(const lattice::PressSetup& setup);

/// Where scaled masses change the force by more than lattice::tolerated_deviation, by how much and
/// what would not; and that plain masses are pressed where scaled ones do not serve.
std::vector<std::string> scaling_notes(const lattice::PressSetup& setup);
/// What run.integrator = auto has taken for a press.
std::string integrator_note(const lattice::PressSetup& setup);

/// That a press takes long (above half a minute, roughly estimated, with so many threads), where
/// scaled masses would be five times as fast; with what they would change of the force.
std::optional<std::string> duration_note(const lattice::PressSetup& setup, int threads);

}  // namespace fingertip::studies::inline presses
