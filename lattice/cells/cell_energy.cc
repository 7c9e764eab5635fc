#include "lattice/cells/cell_energy.h"

#include "lattice/cells/cell_energy_kernel.h"

namespace fingertip::lattice {

double fast_cell_energy(const CellLattice& cells, const VectorField& displacement, int width) {
  kernel::CellArrays arrays{};
  for (std::size_t c = 0; c < 3; ++c) arrays.displacement[c] = displacement.component[c].data();
  arrays.cut = cells.cut.data();
  arrays.row = cells.row;
  arrays.plane = cells.plane;
  arrays.spacing = cells.spacing;
  arrays.material = cells.material;
  return kernel::select_cell_energy(cells.material.kind, width)(arrays, cells.blocks.data(),
                                                                cells.blocks.size());
}

}  // namespace fingertip::lattice
