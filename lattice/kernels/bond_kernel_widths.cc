// The kernels of the bond, compiled once per instruction set (lattice/CMakeLists.txt).
#include "lattice/kernels/bond_kernel_body.h"

namespace fingertip::lattice::inline kernels::kernel {

using Pack = std::experimental::native_simd<double>;

template <int width>
const BondKernels& bond_at() {
  return BondBody<Pack>::kernels;
}
template const BondKernels& bond_at<int(Pack::size())>();

}  // namespace fingertip::lattice::inline kernels::kernel
