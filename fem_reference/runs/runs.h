/// Press, natural vibrations and press with inertia as runs: meshes refined until the result is
/// known well enough, files after each sample. Free of deal.II.
///
/// All processes of MPI_COMM_WORLD take part, the first one writes into `folder`; files and
/// progress: run.h.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>

#include "fem_reference/job/job.h"
#include "fem_reference/runs/run_progress.h"

namespace fingertip::fem_reference::inline runs {

/// A press (analysis static), with checkpoints: resumes from `folder`/checkpoint when it belongs to
/// the same job.
RunOutcome run_press(const std::filesystem::path& folder, const ReferenceJob& job,
                     std::ostream& progress, const std::function<bool()>& stop_requested);

/// What such a press will take, as far as its first mesh tells.
struct PressCost {
  double unknowns = 0.0;  ///< of the first mesh
  Expected expected;      ///< of all meshes that are sure
};

/// Makes the first mesh of a press, `folder`/tip.msh, and nothing else. One process. Throws
/// NotConverged where there is no mesh.
PressCost press_cost(const std::filesystem::path& folder, const ReferenceJob& job);

/// Analysis::modes. Writes tip.msh, modes.csv (`mode,frequency [Hz],frequency_error
/// [Hz],symmetry,multiplicity`), fields and summary.json.
///
/// Meshes whose counts grow from `refinement` by about √2 follow one another until the estimated
/// error of every frequency is below `tolerance` times the frequency, two meshes at least. Errors
/// are estimated like forces' (force_error.h): the frequencies of displacement elements fall toward
/// the exact ones like h^(2 degree), but the singularity at the bond's free edge slows them down,
/// and the estimate assumes order 1.5.
RunOutcome run_modes(const std::filesystem::path& folder, const ReferenceJob& job,
                     std::ostream& progress, const std::function<bool()>& stop_requested);

/// Analysis::transient. Writes response.csv, contact_field.csv, transient.csv (`time [s],indentation
/// [m],normal_force [N],contact_force [N]`, at most 2000 rows), convergence.csv, fields and
/// summary.json.
///
/// The mesh comes from a static frictionless press to the same samples, refined until its force
/// error meets `tolerance`; the transient takes the coarsest of its meshes whose static forces are
/// all within twice the tolerance of the finest one's. `force_error` is the sum of that mesh's
/// static error, relative to the force, and of the change of the transient force when the steps are
/// doubled. Without `estimate_error` the first mesh is taken and `force_error` is empty.
RunOutcome run_transient(const std::filesystem::path& folder, const ReferenceJob& job,
                         std::ostream& progress, const std::function<bool()>& stop_requested);

}  // namespace fingertip::fem_reference::inline runs
