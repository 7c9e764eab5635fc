/// Which of three kernels serves a register width.
#pragma once

#include <stdexcept>

#include "lattice/kernels/kernel.h"

namespace fingertip::lattice::kernel {

/// The one for that many doubles per register. Throws std::invalid_argument for another number than
/// 2, 4 and 8.
template <typename Kernel>
Kernel by_width(int width, Kernel two, Kernel four, Kernel eight) {
  switch (width) {
    case 2: return two;
    case 4: return four;
    case 8: return eight;
    default: throw std::invalid_argument("a kernel's register width must be 2, 4 or 8");
  }
}

/// `width`, or where that is 0 the widest that the processor has.
inline int or_widest(int width) {
  return width == 0 ? supported_width() : width;
}

}  // namespace fingertip::lattice::kernel
