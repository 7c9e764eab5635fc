/// Interface of the vectorised energy of the cells: raw arrays only, as in cell_kernel.h.
#pragma once

#include <cstddef>

#include "lattice/kernels/cell_kernel.h"

namespace fingertip::lattice::inline kernels::kernel {

/// Energy of blocks[0, count) [J], forces and velocities are not looked at; infinite where the law
/// needs J > 0 and has not got it. The same bits for any width.
using CellEnergy = double (*)(const CellArrays& arrays, const CellBlock* blocks, std::size_t count);

/// The kernel for a law and a number of doubles per register, as select_cells().
CellEnergy select_cell_energy(CellLawKind law, int width);

/// That of one compilation (cell_kernel_widths.cc).
template <int width>
CellEnergy cell_energy_at(CellLawKind law);

}  // namespace fingertip::lattice::inline kernels::kernel
