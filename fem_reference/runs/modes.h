/// Natural vibrations as a run: meshes refined until the frequencies are known well enough. Free of
/// deal.II.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>

#include "fem_reference/job/job.h"
#include "fem_reference/runs/run_progress.h"

namespace fingertip::fem_reference::inline runs {

/// Carries out a job with Analysis::modes; the contract is that of `run_job`. Writes tip.msh,
/// modes.csv (`mode,frequency [Hz],frequency_error [Hz],symmetry,multiplicity`), fields and
/// summary.json.
///
/// Meshes whose counts grow from `refinement` by about √2 follow one another until the estimated
/// error of every frequency is below `tolerance` times the frequency, two meshes at least. Errors
/// are estimated like forces' (force_error.h): the frequencies of displacement elements fall toward
/// the exact ones like h^(2 degree), but the singularity at the bond's free edge slows them down,
/// and the estimate assumes order 1.5.
RunOutcome run_modes(const std::filesystem::path& folder, const ReferenceJob& job,
                     std::ostream& progress, const std::function<bool()>& stop_requested);

}  // namespace fingertip::fem_reference::inline runs
