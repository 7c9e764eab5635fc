/// Eight single-precision numbers, for the loops that are compiled once per instruction set.
#pragma once

#include <experimental/simd>

#include "lattice/kernels/stencil.h"

namespace fingertip::lattice::inline dynamics::inline scaling::sweeps {

/// Its type differs between compilations, as in kernels/packs.h.
using Eight = std::experimental::simd<float, std::experimental::simd_abi::deduce_t<float, lanes>>;

/// Doubles per register of this compilation.
inline constexpr int native_width = int(std::experimental::native_simd<double>::size());

[[gnu::always_inline]] inline Eight read(const float* from) {
  return Eight(from, std::experimental::element_aligned);
}
[[gnu::always_inline]] inline void write(float* to, const Eight& from) {
  from.copy_to(to, std::experimental::element_aligned);
}

}  // namespace fingertip::lattice::inline dynamics::inline scaling::sweeps
