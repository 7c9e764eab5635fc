// The kernel of the cells for AVX2: compiled with that instruction set's flags (CMakeLists.txt).
#include "lattice/kernels/cell_kernel_body.h"

namespace fingertip::lattice::kernel {

using Pack = std::experimental::native_simd<double>;
static_assert(Pack::size() == 4, "wrong compiler flags");

CellSweep cells_width4(CellLawKind law, bool rates) {
  return CellBody<Pack>::select(law, rates);
}

CellEnergy cell_energy_width4(CellLawKind law) {
  return CellBody<Pack>::select_energy(law);
}

}  // namespace fingertip::lattice::kernel
