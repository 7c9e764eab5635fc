/// From section [controller] to what makes the controller of a press.
#pragma once

#include "lattice/press/press_setup.h"
#include "studies/config/loader.h"

namespace fingertip::studies::inline presses {

/// Sets make_controller, controller_identity and follows_path of `setup`, which is otherwise
/// complete, as controller.type says; pid leaves them as they are. Force control has no depth to
/// end at: where press.duration is auto, it ends when the approach could have reached the depth and
/// ten time constants of the force's loop have passed. Presses that no controller moves are left
/// alone. Throws ConfigError for settings that break a rule and for a schedule that cannot be used.
void choose_controller(const LoadedConfig& loaded, lattice::PressSetup& setup);

/// Whether the same press gives the same result again. What a controller in another process does
/// is not known to the program.
bool repeatable(const lattice::PressSetup& setup);

}  // namespace fingertip::studies::inline presses
