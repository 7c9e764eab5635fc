/// A static press as a run: meshes refined until the force is known well enough, files after each
/// sample, checkpoints. Free of deal.II.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>

#include "fem_reference/job/job.h"
#include "fem_reference/runs/run_progress.h"

namespace fingertip::fem_reference::inline runs {

/// Carries out a press (analysis static) inside `folder`; see run.h for files and progress. All
/// processes of MPI_COMM_WORLD take part, the first one writes. Resumes from `folder`/checkpoint
/// when it belongs to the same job.
RunOutcome run_press(const std::filesystem::path& folder, const ReferenceJob& job,
                     std::ostream& progress, const std::function<bool()>& stop_requested);

}  // namespace fingertip::fem_reference::inline runs
