#include "fem_reference/run.h"

#include "fem_reference/job/job.h"
#include "fem_reference/runs/runs.h"
#include "fem_reference/solvers/solver_choice.h"
#include "fem_reference/verification/verification.h"

namespace fingertip::fem_reference {

RunOutcome run_job(const std::filesystem::path& folder, std::ostream& progress,
                   const std::function<bool()>& stop_requested) {
  const ReferenceJob job = read_job(folder / "job.json");
  choose_solver(job, 0.0);  // refuses before anything is written
  if (job.analysis == Analysis::modes) return run_modes(folder, job, progress, stop_requested);
  if (job.analysis == Analysis::transient)
    return run_transient(folder, job, progress, stop_requested);
  if (job.analysis == Analysis::verification)
    return run_verification(folder, job, progress, stop_requested);
  return run_press(folder, job, progress, stop_requested);
}

}  // namespace fingertip::fem_reference
