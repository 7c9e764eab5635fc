/// Which of three compilations of a kernel serves: SSE2, AVX2 or AVX-512.
#pragma once

#include <stdexcept>

namespace fingertip::lattice::inline kernels::kernel {

/// Most doubles per register, of 2, 4, 8, that the running processor supports.
int supported_width();

/// The one for that many doubles per register, which the caller makes sure that the processor has,
/// or for the widest that it has (0). Throws std::invalid_argument for another number.
template <typename Kernel>
Kernel by_width(int width, Kernel two, Kernel four, Kernel eight) {
  switch (width == 0 ? supported_width() : width) {
    case 2: return two;
    case 4: return four;
    case 8: return eight;
    default: throw std::invalid_argument("a kernel's register width must be 2, 4 or 8");
  }
}

}  // namespace fingertip::lattice::inline kernels::kernel
