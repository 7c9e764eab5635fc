#include "fem_reference/job/processes.h"

#include <mpi.h>

#include "meshes/base/errors.h"

namespace fingertip::fem_reference::inline job {

bool first_process() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank == 0;
}

void stop_if_asked(const std::function<bool()>& stop_requested) {
  const int own = stop_requested && stop_requested() ? 1 : 0;
  int any = 0;
  MPI_Allreduce(&own, &any, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  if (any != 0) throw meshes::Interrupted("stopped on request");
}

}  // namespace fingertip::fem_reference::inline job
