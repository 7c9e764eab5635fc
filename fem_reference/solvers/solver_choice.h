/// Which linear solver a press gets, and what it costs. Free of deal.II; MPI inside.
#pragma once

#include <cstddef>

#include "fem_reference/job/job.h"
#include "meshes/press/press_response.h"

namespace fingertip::fem_reference::inline solvers {

/// What the job's `automatic` means for a mesh of so many unknowns on the processes of
/// MPI_COMM_WORLD; any other choice stands, but a meridian is always factored. Throws InvalidInput
/// for a meridian or the condensed solver on several processes.
LinearSolver choose_solver(const ReferenceJob& job, double unknowns);

/// What a static press costs on one mesh, more on the first of a sequence, on which its way is
/// found: within a factor of two on two cores of a desktop, from presses of solids with 4e3 to 4e5
/// unknowns (MEASUREMENTS.md); for what is told beforehand.
struct SolutionCost {
  double mesh = 0.0;    ///< to assemble, and to factor what serves all samples [s]
  double sample = 0.0;  ///< of one equilibrium [s]
  double memory = 0.0;  ///< peak of all processes together [byte]
};
SolutionCost solution_cost(const ReferenceJob& job, double unknowns, bool first_mesh);

/// Of the job's elements on a mesh of `cells` quadrilaterals or hexahedra with `corners`. By
/// Euler's formula it has corners + cells - 1 edges, or 2 corners + cells - 1 edges and corners + 2
/// cells faces, on which the nodes of a degree above 1 stand; the faces would take those of the
/// boundary, here twice corners - cells, as on a regular grid: within a tenth for divided
/// tetrahedra.
double expected_unknowns(const ReferenceJob& job, double cells, double corners);

/// What a run will still take, where it can tell.
struct Expected {
  double left = meshes::unknown;  ///< [s]
  double memory = 0.0;            ///< peak [byte]
};

/// What is left of presses on one mesh after the other, told in this order: begin or resume;
/// assembled, pressed for each sample; refine, and again assembled.
class PressWork {
 public:
  /// At least `fewest_meshes`, where the error is estimated, with so many samples on each.
  PressWork(const ReferenceJob& job, std::size_t samples, std::size_t fewest_meshes);

  void begin(double unknowns);
  void resume(double unknowns, std::size_t meshes, std::size_t samples_done);
  void assembled(double unknowns);
  void pressed();
  void refine();

  /// Of the mesh at hand, on which so many samples are wanted, and those that are sure to follow,
  /// at the pace of the work so far, which took `wall_time` [s].
  Expected expected(double wall_time, std::size_t wanted) const;

 private:
  SolutionCost cost() const;  ///< of the mesh at hand
  double growth() const;      ///< of the unknowns, to the next

  const ReferenceJob& job_;
  const std::size_t samples_, fewest_meshes_;
  double unknowns_ = 0.0;  ///< of the mesh at hand
  bool assembled_ = false;
  std::size_t number_ = 1;   ///< of that mesh
  std::size_t pressed_ = 0;  ///< samples on it
  double work_done_ = 0.0;   ///< [s], by solution_cost
};

}  // namespace fingertip::fem_reference::inline solvers
