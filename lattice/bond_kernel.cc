#include "lattice/bond_kernel.h"

#include <stdexcept>

#include "lattice/kernel.h"

namespace fingertip::lattice::kernel {

const BondKernels& select_bond(int width) {
  switch (width == 0 ? supported_width() : width) {
    case 2: return bond_width2();
    case 4: return bond_width4();
    case 8: return bond_width8();
    default: throw std::invalid_argument("kernel::select_bond: width must be 2, 4 or 8");
  }
}

}  // namespace fingertip::lattice::kernel
