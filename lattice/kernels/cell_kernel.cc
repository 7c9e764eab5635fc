#include "lattice/kernels/cell_kernel.h"

#include "lattice/kernels/by_width.h"
#include "lattice/kernels/cell_energy_kernel.h"

namespace fingertip::lattice::kernel {

CellSweep select_cells(CellLawKind law, bool rates, int width) {
  return by_width(or_widest(width), cells_width2, cells_width4, cells_width8)(law, rates);
}

CellEnergy select_cell_energy(CellLawKind law, int width) {
  return by_width(or_widest(width), cell_energy_width2, cell_energy_width4,
                  cell_energy_width8)(law);
}

}  // namespace fingertip::lattice::kernel
