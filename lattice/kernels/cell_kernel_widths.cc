// The kernels of the cells, compiled once per instruction set (lattice/CMakeLists.txt).
#include "lattice/kernels/cell_kernel_body.h"

namespace fingertip::lattice::kernel {

using Pack = std::experimental::native_simd<double>;

template <int width>
CellSweep cells_at(CellLawKind law, bool rates, bool fades) {
  return CellBody<Pack>::select(law, rates, fades);
}
template CellSweep cells_at<int(Pack::size())>(CellLawKind, bool, bool);

template <int width>
CellEnergy cell_energy_at(CellLawKind law) {
  return CellBody<Pack>::select_energy(law);
}
template CellEnergy cell_energy_at<int(Pack::size())>(CellLawKind);

}  // namespace fingertip::lattice::kernel
