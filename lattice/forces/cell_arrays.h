/// What the kernels of the cells borrow.
#pragma once

#include "lattice/kernels/cell_kernel.h"
#include "lattice/model/cell_lattice.h"
#include "lattice/model/state.h"

namespace fingertip::lattice::inline forces {

/// Of a lattice and a displacement; velocities and forces are the caller's to fill in.
inline kernel::CellArrays cell_arrays(const CellLattice& cells, const VectorField& displacement) {
  kernel::CellArrays arrays{};
  for (std::size_t c = 0; c < 3; ++c) arrays.displacement[c] = displacement.component[c].data();
  arrays.cut = cells.cut.data();
  arrays.row = cells.row;
  arrays.plane = cells.plane;
  arrays.spacing = cells.spacing;
  arrays.material = cells.material;
  return arrays;
}

}  // namespace fingertip::lattice::inline forces
