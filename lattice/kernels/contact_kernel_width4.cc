// The kernels of the contact for AVX2: compiled with that instruction set's flags (CMakeLists.txt).
#include "lattice/kernels/contact_kernel_body.h"

namespace fingertip::lattice::kernel {

using Pack = std::experimental::native_simd<double>;
static_assert(Pack::size() == 4, "wrong compiler flags");

const ContactKernels& contact_width4() {
  return ContactBody<Pack>::kernels;
}

}  // namespace fingertip::lattice::kernel
