/// Eight values side by side, as the kernels of the surfaces read them.
#pragma once

#include "lattice/kernels/stencil.h"

namespace fingertip::lattice::inline kernels::kernel {

/// In one line of the cache: loads that straddle two cost twice.
struct alignas(64) Lanes {
  double at[lanes];
};

}  // namespace fingertip::lattice::inline kernels::kernel
