#include "lattice/contact_kernel.h"

#include <stdexcept>

#include "lattice/kernel.h"

namespace fingertip::lattice::kernel {

const ContactKernels& select_contact(int width) {
  switch (width == 0 ? supported_width() : width) {
    case 2: return contact_width2();
    case 4: return contact_width4();
    case 8: return contact_width8();
    default: throw std::invalid_argument("kernel::select_contact: width must be 2, 4 or 8");
  }
}

}  // namespace fingertip::lattice::kernel
