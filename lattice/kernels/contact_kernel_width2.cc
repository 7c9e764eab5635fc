// The kernels of the contact for every x86-64 (SSE2).
#include "lattice/kernels/contact_kernel_body.h"

namespace fingertip::lattice::kernel {

using Pack = std::experimental::native_simd<double>;
static_assert(Pack::size() == 2, "wrong compiler flags");

const ContactKernels& contact_width2() {
  return ContactBody<Pack>::kernels;
}

}  // namespace fingertip::lattice::kernel
