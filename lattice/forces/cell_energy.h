/// Energy of the cells of a lattice, fast.
#pragma once

#include "lattice/model/cell_lattice.h"
#include "lattice/model/state.h"
#include "lattice/threads/parallel.h"

namespace fingertip::lattice::inline forces {

/// Of all cells (CellMaterial) [J]; infinite where the law needs J > 0 and has not got it. `width`:
/// doubles per register (2, 4, 8), 0 for the widest the processor has; the same bits for any, and
/// for any number of threads.
double cell_energy(const CellLattice& cells, const VectorField& displacement, Team& team,
                   int width = 0);
/// Of cells that consist of something else.
double cell_energy(const CellLattice& cells, const CellMaterial& material,
                   const VectorField& displacement, Team& team, int width = 0);

}  // namespace fingertip::lattice::inline forces
