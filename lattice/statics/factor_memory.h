/// Tells lack of memory from a matrix that is not positive definite.
#pragma once

#include <cholmod.h>

#include <string>

#include "meshes/base/errors.h"

namespace fingertip::lattice::inline statics {

/// Throws NotConverged when CHOLMOD's last call found too little memory for a matrix of `unknowns`
/// rows: shifts and smaller steps would not help.
inline void require_memory(const cholmod_common& cholmod, long unknowns) {
  if (cholmod.status != CHOLMOD_OUT_OF_MEMORY && cholmod.status != CHOLMOD_TOO_LARGE) return;
  throw meshes::NotConverged("there is not enough memory to factorise the stiffness of " +
                             std::to_string(unknowns) + " unknowns; take a coarser lattice");
}

}  // namespace fingertip::lattice::inline statics
