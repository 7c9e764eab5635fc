#include "lattice/kernels/contact_kernel.h"

#include "lattice/kernels/by_width.h"

namespace fingertip::lattice::kernel {

const ContactKernels& select_contact(int width) {
  return by_width(or_widest(width), contact_width2, contact_width4, contact_width8)();
}

}  // namespace fingertip::lattice::kernel
