/// How a run ended that threw.
#pragma once

#include <exception>

namespace fingertip::studies::inline jobs {

/// As the manifest tells it and the program exits.
struct Ending {
  const char* status;
  int exit_code;
};

/// "process lost", "controller failed", "not converged", "could not write": 3; "interrupted": 130;
/// "bad input": 2; "failed": 1.
Ending ending_of(const std::exception& error);

}  // namespace fingertip::studies::inline jobs
