#include "lattice/forces/cell_energy.h"

#include "lattice/forces/cell_arrays.h"
#include "lattice/kernels/cell_kernel.h"
#include "lattice/threads/sum_in_portions.h"

namespace fingertip::lattice::inline forces {

double cell_energy(const CellLattice& cells, const VectorField& displacement, Team& team,
                   int width) {
  return cell_energy(cells, cells.material, displacement, team, width);
}

double cell_energy(const CellLattice& cells, const CellMaterial& material,
                   const VectorField& displacement, Team& team, int width) {
  const kernel::CellEnergy energy = kernel::select_cell_energy(material.kind, width);
  kernel::CellArrays arrays = cell_arrays(cells, displacement);
  arrays.material = material;
  return sum_in_portions<64>(team, cells.blocks.size(), [&](std::size_t begin, std::size_t end) {
    return energy(arrays, cells.blocks.data() + begin, end - begin);
  });
}

}  // namespace fingertip::lattice::inline forces
