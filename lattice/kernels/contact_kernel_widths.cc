// The kernels of the contact, compiled once per instruction set (lattice/CMakeLists.txt).
#include "lattice/kernels/contact_kernel_body.h"

namespace fingertip::lattice::inline kernels::kernel {

using Pack = std::experimental::native_simd<double>;

template <int width>
const ContactKernels& contact_at() {
  return ContactBody<Pack>::kernels;
}
template const ContactKernels& contact_at<int(Pack::size())>();

}  // namespace fingertip::lattice::inline kernels::kernel
