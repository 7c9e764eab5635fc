#include "lattice/cells/cell_energy.h"

#include <array>
#include <numeric>

#include "lattice/cells/cell_arrays.h"
#include "lattice/cells/cell_energy_kernel.h"

namespace fingertip::lattice {

double fast_cell_energy(const CellLattice& cells, const VectorField& displacement, Team& team,
                        int width) {
  constexpr std::size_t portions = 64;  // the same for any number of threads
  const kernel::CellEnergy energy = kernel::select_cell_energy(cells.material.kind, width);
  const kernel::CellArrays arrays = cell_arrays(cells, displacement);
  const std::size_t blocks = cells.blocks.size();
  std::array<double, portions> part{};
  team.split(portions, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const std::size_t first = p * blocks / portions, last = (p + 1) * blocks / portions;
      part[p] = energy(arrays, cells.blocks.data() + first, last - first);
    }
  });
  return std::accumulate(part.begin(), part.end(), 0.0);
}

}  // namespace fingertip::lattice
