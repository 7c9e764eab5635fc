/// Runs another program to its end or to a time limit and measures what it took.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace fingertip::benchmarks {

/// What a run took, from the kernel's own books.
struct Cost {
  bool finished = false;        ///< ended by itself with exit code 0
  bool timed_out = false;       ///< was ended at the limit
  int exit_code = -1;           ///< -1 when a signal ended it
  double wall_seconds = 0.0;    ///< [s]
  double cpu_seconds = 0.0;     ///< user and system time, all threads [s]
  std::size_t peak_memory = 0;  ///< largest resident set [bytes], at least that of this program
};

/// Runs `command` (program, arguments) in `folder` with the further environment entries
/// "NAME=value" and everything it prints in `log`. Ends it, and it alone, after `limit` seconds.
/// Throws std::runtime_error when it cannot be started.
Cost run_child(const std::vector<std::string>& command, const std::filesystem::path& folder,
               const std::vector<std::string>& environment, double limit,
               const std::filesystem::path& log);

}  // namespace fingertip::benchmarks
