// The kernels of the bond for every x86-64 (SSE2).
#include "lattice/kernels/bond_kernel_body.h"

namespace fingertip::lattice::kernel {

using Pack = std::experimental::native_simd<double>;
static_assert(Pack::size() == 2, "wrong compiler flags");

const BondKernels& bond_width2() {
  return BondBody<Pack>::kernels;
}

}  // namespace fingertip::lattice::kernel
