// The kernels of the bond for AVX2: compiled with that instruction set's flags (CMakeLists.txt).
#include "lattice/kernels/bond_kernel_body.h"

namespace fingertip::lattice::kernel {

using Pack = std::experimental::native_simd<double>;
static_assert(Pack::size() == 4, "wrong compiler flags");

const BondKernels& bond_width4() {
  return BondBody<Pack>::kernels;
}

}  // namespace fingertip::lattice::kernel
