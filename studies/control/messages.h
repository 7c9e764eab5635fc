/// The lines of the lock-step protocol (README: a table of them): one JSON object each.
#pragma once

#include <string>
#include <string_view>

#include "lattice/control/controller.h"
#include "lattice/control/task.h"

namespace fingertip::studies::inline control {

inline constexpr int control_protocol_version = 1;
inline constexpr std::size_t longest_control_line = 65536;  ///< [bytes], without the line feed

/// Of the program. Without the line feed; numbers are the shortest texts that read back as exactly
/// the same double (at most 17 significant digits).
std::string hello_line(const lattice::ControlTask& task, double timeout, bool resumed);
std::string measurement_line(const lattice::Measurement& measurement,
                             const lattice::ControlTask& task, long cycle);
std::string reset_line();
std::string bye_line(const std::string& reason);

/// Reads the client's hello. Throws ControllerFailed when it is none, or of another version.
void check_hello(std::string_view line);

/// Reads the client's answer to a measurement. Throws ControllerFailed for everything but an
/// object with one of "wrench" and "target" and nothing unknown in it.
lattice::Command parse_command(std::string_view line);

}  // namespace fingertip::studies::inline control
