#include "lattice/kernels/by_width.h"

namespace fingertip::lattice::inline kernels::kernel {

int supported_width() {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw")) {
    return 8;
  }
  if (__builtin_cpu_supports("avx2")) return 4;
#endif
  return 2;
}

}  // namespace fingertip::lattice::inline kernels::kernel
