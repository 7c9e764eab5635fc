/// What press, reference, calibrate and validate have in common.
#pragma once

#include <functional>
#include <string>

#include "studies/cli/command_line/command_line.h"
#include "studies/jobs/session.h"

namespace fingertip::studies::inline cli::inline command_line {

/// Prepares the run folder, runs `body` in it and completes the manifest whatever happens. Bad
/// input that only shows during the run (an unstable time step) takes a new folder away again.
/// Returns body's exit code; rethrows what it throws, with violations located in the user's input
/// or, when the folder was kept, with a word on where it is and how to go on.
int run_in_folder(const CommandLine& line, const LoadedConfig& loaded, const std::string& case_text,
                  const std::function<int(Session&)>& body);

/// That jobs may use together.
int cores_for(const LoadedConfig& loaded);

/// The configuration of `line`, checked as a whole.
LoadedConfig load_checked(const CommandLine& line);

}  // namespace fingertip::studies::inline cli::inline command_line
