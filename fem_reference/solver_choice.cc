#include "fem_reference/solver_choice.h"

#include <mpi.h>

#include <string>

#include "meshes/errors.h"

namespace fingertip::fem_reference {
namespace {

/// Above this many unknowns the factor outgrows a desktop's memory (4.4 GB peak at 240 000), and
/// multigrid takes over.
constexpr double largest_condensed = 300000;

}  // namespace

LinearSolver choose_solver(const ReferenceJob& job, double unknowns) {
  const LinearSolver wanted = job.solver;
  int processes = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &processes);
  if (job.axisymmetric()) {
    if (processes > 1)
      throw meshes::InvalidInput({"reference.symmetry", std::string(name(job.symmetry)),
                                  "a meridian is solved on one process",
                                  "start one process, or choose reference.symmetry = \"none\""});
    return LinearSolver::condensed;
  }
  const bool curved = job.strain == Strain::finite && !job.protocol.obstacle.is_plane();
  if (curved && (processes > 1 || wanted == LinearSolver::multigrid))
    throw meshes::InvalidInput({"obstacle.shape", std::string(name(job.protocol.obstacle.shape)),
                                "at large strain the contact with what is curved needs the direct "
                                "solver, on one process",
                                "choose reference.solver = \"condensed\" and --ranks 1"});
  if (curved) return LinearSolver::condensed;
  if (wanted == LinearSolver::condensed && processes > 1)
    throw meshes::InvalidInput({"reference.solver", "condensed",
                                "the condensed solver runs on one process",
                                "choose multigrid or automatic, or --ranks 1"});
  if (wanted != LinearSolver::automatic) return wanted;
  return processes == 1 && unknowns <= largest_condensed ? LinearSolver::condensed
                                                         : LinearSolver::multigrid;
}

}  // namespace fingertip::fem_reference
