/// Which linear solver a press gets. Free of deal.II; MPI inside.
#pragma once

#include "fem_reference/job.h"

namespace fingertip::fem_reference {

/// What `automatic` means for a mesh of so many unknowns on the processes of MPI_COMM_WORLD; any
/// other choice stands. Throws InvalidInput for the condensed solver on several processes.
LinearSolver choose_solver(LinearSolver wanted, double unknowns);

}  // namespace fingertip::fem_reference
