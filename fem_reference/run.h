/// Carries out a reference job inside its run folder. Free of deal.II.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>

#include "fem_reference/runs/run_progress.h"

namespace fingertip::fem_reference {

/// Reads `folder`/job.json and writes the results into `folder` (README lists the files).
/// Everything is rewritten after each sample, so that a run that ends early keeps what it has, and
/// `folder`/checkpoint lets the same job go on where it stopped. `progress` receives one JSON
/// object per line. `stop_requested` is asked between the steps of the press. All processes of
/// MPI_COMM_WORLD call it together; MPI must be initialised. Throws InvalidInput, having written
/// nothing, for a bad job; std::runtime_error for a folder that cannot be written.
RunOutcome run_job(const std::filesystem::path& folder, std::ostream& progress,
                   const std::function<bool()>& stop_requested);

/// What the press of `folder`/job.json (analysis static) will take, from its first mesh, which is
/// written there: {"unknowns" of that mesh, "time" [s], "memory" [byte]}. Not converged where there
/// is no mesh. Throws as run_job.
RunOutcome tell_cost(const std::filesystem::path& folder, std::ostream& out);

}  // namespace fingertip::fem_reference
