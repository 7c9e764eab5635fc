/// What press, reference, calibrate and validate have in common.
#pragma once

#include <functional>
#include <string>

#include "studies/cli/command_line/command_line.h"
#include "studies/jobs/session.h"

namespace fingertip::studies::inline cli::inline command_line {

/// Prepares the run folder, runs `body` in it and completes the manifest whatever happens. Bad
/// input that only shows during the run (an unstable time step) takes a new folder away again.
/// Returns body's exit code; rethrows what it throws, violations located in the user's input. Where
/// the folder is kept, stderr tells where it is and how to go on.
int run_in_folder(const CommandLine& line, const LoadedConfig& loaded, const std::string& case_text,
                  const std::function<int(Session&)>& body);

/// How long the job of the run took, and where its files are, for the screen.
void print_folder(const Session& session, const JobResult& result);

/// Does what a run can do without. What failed, in words, empty where all went well; only an
/// interrupt and a file that cannot be written end the run, too.
std::string failure_of(const std::function<void()>& work);

/// That jobs may use together.
int cores_for(const LoadedConfig& loaded);

/// The configuration of `line`, checked as a whole.
LoadedConfig load_checked(const CommandLine& line);

}  // namespace fingertip::studies::inline cli::inline command_line
