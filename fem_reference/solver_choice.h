/// Which linear solver a press gets. Free of deal.II; MPI inside.
#pragma once

#include "fem_reference/job.h"

namespace fingertip::fem_reference {

/// What the job's `automatic` means for a mesh of so many unknowns on the processes of
/// MPI_COMM_WORLD; any other choice stands, but a meridian is always factored. Throws InvalidInput
/// for a meridian or the condensed solver on several processes.
LinearSolver choose_solver(const ReferenceJob& job, double unknowns);

}  // namespace fingertip::fem_reference
