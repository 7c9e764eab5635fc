/// Which of the compilations of a kernel serves: SSE2, AVX2 or AVX-512 on x86-64, elsewhere one.
#pragma once

#include <stdexcept>
#include <type_traits>
#include <utility>

namespace fingertip::lattice::inline kernels::kernel {

/// Doubles per register of the compilations that there are (instruction_sets).
#ifdef __x86_64__
using Widths = std::integer_sequence<int, 2, 4, 8>;
#else  // NEON, WebAssembly
using Widths = std::integer_sequence<int, 2>;
#endif

/// Most doubles per register, of Widths, that the running processor supports.
int supported_width();

template <typename Choose, int... width>
auto by_width(int wanted, const Choose& choose, std::integer_sequence<int, width...>) {
  std::common_type_t<decltype(choose(std::integral_constant<int, width>()))...> kernel = nullptr;
  ((wanted == width ? void(kernel = choose(std::integral_constant<int, width>())) : void()), ...);
  if (!kernel) throw std::invalid_argument("there is no kernel of this register width");
  return kernel;
}

/// The one for that many doubles per register, which the caller makes sure that the processor has,
/// or for the widest that it has (0). `choose`, called with the width as a constant, gives a
/// function. Throws std::invalid_argument for another number.
template <typename Choose>
auto by_width(int width, const Choose& choose) {
  return by_width(width == 0 ? supported_width() : width, choose, Widths());
}

}  // namespace fingertip::lattice::inline kernels::kernel
