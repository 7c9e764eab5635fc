/// Between the virtual control interface and the structs of its C twin.
#pragma once

#include "lattice/control/controller.h"
#include "lattice/control/task.h"
#include "studies/control/fingertip_controller.h"

namespace fingertip::studies::inline control {

/// `command` itself. Throws ControllerFailed when a component is not finite or an orientation is
/// not of length one (to 1e-6).
const lattice::Command& checked(const lattice::Command& command);

fingertip_task c_task(const lattice::ControlTask& task);
fingertip_measurement c_measurement(const lattice::Measurement& measurement,
                                    const lattice::ControlTask& task);

/// A command without an answer in it yet.
fingertip_command empty_c_command();
/// What the answer says, checked. Throws ControllerFailed, also for a kind that does not exist.
lattice::Command command_of(const fingertip_command& command);

}  // namespace fingertip::studies::inline control
