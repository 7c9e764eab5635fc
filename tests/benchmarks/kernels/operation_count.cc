#include "operation_count.h"

#include <array>
#include <vector>

#include "counted.h"
// The free functions that the kernels call on their numbers must be known before the kernels are.
#include "lattice/forces/cell_arrays.h"
#include "lattice/kernels/cell_kernel_body.h"
#include "lattice/kernels/kernel_body.h"
#include "lattice/model/state.h"

namespace kernel_probes {

using namespace fingertip::lattice;

namespace {

/// In blocks of one lane nothing is carried from a cell to the next through a shuffle of lanes.
[[gnu::noinline]] void run_springs(const LatticeModel& model, const State& state,
                                   VectorField& force) {
  const bool finite = model.kinematics == Kinematics::finite;
  const bool rates = finite || !model.proportional_damping;
  kernel::Arrays a{};
  for (std::size_t c = 0; c < 3; ++c) {
    a.displacement[c] = state.displacement.component[c].data();
    a.velocity[c] = state.velocity.component[c].data();
    a.force[c] = force.component[c].data();
  }
  for (std::size_t s = 0; s < directions; ++s) {
    a.weight[s] = model.weight[s].data();
    a.neighbour[s] = neighbour_offset(model.grid.size, int(s));
  }
  a.spacing = model.spacing();
  std::copy(model.stiffness.begin(), model.stiffness.end(), a.stiffness);
  std::copy(model.damping.begin(), model.damping.end(), a.damping);
  std::vector<double> pulls(kernel::pulls_size(a.neighbour[along_axis[2]]));
  kernel::Body<Counted>::select({finite, rates})(a, model.blocks.data(), 0, model.blocks.size(),
                                                 pulls.data());
  // u + tau v ahead of a single pass.
  if (!rates) Counted::operations += 6.0 * double(model.blocks.size() * lanes);
}

[[gnu::noinline]] void run_cells(const CellLattice& cells, const State& state, VectorField& force) {
  kernel::CellArrays a = cell_arrays(cells, state.displacement);
  for (std::size_t c = 0; c < 3; ++c) {
    a.velocity[c] = state.velocity.component[c].data();
    a.force[c] = force.component[c].data();
  }
  const bool rates =
      cells.material.kind != CellLawKind::cubic && cells.material.retardation_time > 0.0;
  kernel::CellBounds bounds;
  kernel::CellBody<Counted>::select(cells.material.kind,
                                    rates ? kernel::CellTask::damped : kernel::CellTask::elastic)(
      a, cells.blocks.data(), 0, cells.blocks.size(), bounds);
}

}  // namespace

double operations_per_spring(const LatticeModel& model) {
  const State rest(model);
  VectorField force(model.points());
  Counted::operations = 0.0;
  if (model.has_springs()) run_springs(model, rest, force);
  run_cells(model.cell_lattice, rest, force);
  return Counted::operations / double(model.spring_count());
}

}  // namespace kernel_probes
