#include "lattice/cells/cell_energy.h"

#include "lattice/cells/cell_arrays.h"
#include "lattice/cells/cell_energy_kernel.h"

namespace fingertip::lattice {

double fast_cell_energy(const CellLattice& cells, const VectorField& displacement, int width) {
  return kernel::select_cell_energy(cells.material.kind, width)(
      cell_arrays(cells, displacement), cells.blocks.data(), cells.blocks.size());
}

}  // namespace fingertip::lattice
