#include "lattice/kernels/bond_kernel.h"

#include "lattice/kernels/by_width.h"

namespace fingertip::lattice::kernel {

const BondKernels& select_bond(int width) {
  return by_width(or_widest(width), bond_width2, bond_width4, bond_width8)();
}

}  // namespace fingertip::lattice::kernel
