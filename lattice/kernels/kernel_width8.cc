// The force kernel for AVX-512: compiled with that instruction set's flags (CMakeLists.txt).
#include "lattice/kernels/kernel_body.h"

namespace fingertip::lattice::kernel {

using Pack = std::experimental::native_simd<double>;
static_assert(Pack::size() == 8, "wrong compiler flags");

Offer offer_width8() {
  return {Body<Pack>::select, Body<Pack>::move};
}

}  // namespace fingertip::lattice::kernel
