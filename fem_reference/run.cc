#include "fem_reference/run.h"

#include <mpi.h>

#include "fem_reference/job.h"
#include "fem_reference/modes.h"
#include "fem_reference/press_run.h"
#include "fem_reference/transient.h"
#include "fem_reference/verification/verification.h"
#include "meshes/errors.h"

namespace fingertip::fem_reference {

RunOutcome run_job(const std::filesystem::path& folder, std::ostream& progress,
                   const std::function<bool()>& stop_requested) {
  const ReferenceJob job = read_job(folder / "job.json");
  int processes = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &processes);
  if (job.solver == LinearSolver::condensed && processes > 1)
    throw meshes::InvalidInput({"reference.solver", "condensed",
                                "the condensed solver runs on one process",
                                "choose multigrid or automatic, or --ranks 1"});
  if (job.analysis == Analysis::modes) return run_modes(folder, job, progress, stop_requested);
  if (job.analysis == Analysis::transient)
    return run_transient(folder, job, progress, stop_requested);
  if (job.analysis == Analysis::verification)
    return run_verification(folder, job, progress, stop_requested);
  return run_press(folder, job, progress, stop_requested);
}

}  // namespace fingertip::fem_reference
