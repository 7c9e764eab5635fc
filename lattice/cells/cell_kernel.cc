#include "lattice/cells/cell_kernel.h"

#include <stdexcept>

#include "lattice/cells/cell_energy_kernel.h"
#include "lattice/kernel.h"

namespace fingertip::lattice::kernel {

CellSweep select_cells(CellLawKind law, bool rates, int width) {
  switch (width == 0 ? supported_width() : width) {
    case 2: return cells_width2(law, rates);
    case 4: return cells_width4(law, rates);
    case 8: return cells_width8(law, rates);
    default: throw std::invalid_argument("kernel::select_cells: width must be 2, 4 or 8");
  }
}

CellEnergy select_cell_energy(CellLawKind law, int width) {
  switch (width == 0 ? supported_width() : width) {
    case 2: return cell_energy_width2(law);
    case 4: return cell_energy_width4(law);
    case 8: return cell_energy_width8(law);
    default: throw std::invalid_argument("kernel::select_cell_energy: width must be 2, 4 or 8");
  }
}

}  // namespace fingertip::lattice::kernel
