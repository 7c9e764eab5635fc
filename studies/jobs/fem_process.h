/// The other program: fingertip-fem, started as a job.
#pragma once

#include <filesystem>

#include "studies/jobs/job.h"

namespace fingertip::studies::inline jobs {

/// Runs `program` on `folder` (with its job.json inside) as `context.ranks` MPI ranks and waits.
/// Its stdout, JSON lines {"stage", "done", "total", "message", "left", "memory"}, becomes
/// progress; messages, other lines and stderr go to the log. When `context.report` returns false
/// every rank gets SIGINT; what is still there ten seconds later is killed. Throws InvalidInput
/// (the program or mpirun is missing, or it exits with 2), NotConverged (3), Interrupted (130),
/// ProcessLost (a signal ended it, or one of its ranks), std::runtime_error (anything else), with
/// the last words on its stderr.
void run_fem_process(const std::filesystem::path& program, const std::filesystem::path& folder,
                     const JobContext& context);

}  // namespace fingertip::studies::inline jobs
