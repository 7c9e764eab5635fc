/// Other programs whose speed is measured.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fingertip::studies {

/// Runs `words` (program with its path, arguments) with everything it prints in the file `output`,
/// and waits. `environment`: "NAME=value". Returns its exit code, -1 when a signal ended it. Throws
/// Interrupted when the user stops the run (the program has ended then).
int run_child(const std::vector<std::string>& words, const std::vector<std::string>& environment,
              const std::filesystem::path& output);

}  // namespace fingertip::studies
