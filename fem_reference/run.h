/// Carries out a reference job inside its run folder. Free of deal.II.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>

namespace fingertip::fem_reference {

/// How a run ended, and in which words.
struct RunOutcome {
  enum class Status { ok, interrupted, not_converged };
  Status status = Status::ok;
  std::string message;  ///< empty when ok
};

/// Reads `folder`/job.json and writes into `folder`: tip.msh, response.csv, pressure.csv,
/// section.csv, fields/press_NNNN.vtu with fields/press.pvd, and summary.json (README). Everything
/// is rewritten after each sample, so that a run that ends early keeps what it has. `progress`
/// receives one JSON object per line. `stop_requested` is asked between the steps of the press.
/// Throws InvalidInput, having written nothing, for a bad job; std::runtime_error for a folder that
/// cannot be written. MPI must be initialised.
RunOutcome run_job(const std::filesystem::path& folder, std::ostream& progress,
                   const std::function<bool()>& stop_requested);

}  // namespace fingertip::fem_reference
