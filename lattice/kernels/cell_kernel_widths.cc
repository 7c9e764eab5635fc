// The kernels of the cells, compiled once per instruction set (lattice/CMakeLists.txt).
#include "lattice/kernels/cell_kernel_body.h"

namespace fingertip::lattice::inline kernels::kernel {

using Pack = std::experimental::native_simd<double>;

template <int width>
CellSweep cells_at(CellLawKind law, CellTask task) {
  return CellBody<Pack>::select(law, task);
}
template CellSweep cells_at<int(Pack::size())>(CellLawKind, CellTask);

template <int width>
CellEnergy cell_energy_at(CellLawKind law) {
  return CellBody<Pack>::select_energy(law);
}
template CellEnergy cell_energy_at<int(Pack::size())>(CellLawKind);

}  // namespace fingertip::lattice::inline kernels::kernel
