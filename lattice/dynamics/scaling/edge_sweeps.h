/// The loops of EdgeInertiaRule, over runs of eight cells along x.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "lattice/dynamics/scaling/sweeps.h"
#include "lattice/kernels/stencil.h"

namespace fingertip::lattice::inline dynamics::inline scaling::sweeps {

/// Of one cell's edges; nothing for cells that are not there.
struct EdgeShares {
  Single mean[12][lanes] = {};      ///< CellEdges::mean
  Single majorant[12][lanes] = {};  ///< CellEdges::majorant
  Single spread[12][lanes] = {};    ///< CellEdges::spread

  bool operator==(const EdgeShares&) const = default;
};

/// Eight cells side by side along x.
struct EdgePack {
  std::uint32_t first = 0;          ///< lowest corner of the first one
  std::uint32_t shares = 0;         ///< where in the list
  Single moduli[3][3][lanes] = {};  ///< a M of the cells as they are now [kg]
};

/// Moduli that M is made of, times a [kg].
struct EdgeFactors {
  Single elastic_shear, elastic_bulk, viscous_shear, viscous_bulk;
  Single rest_same, rest_other;  ///< of M at rest, c = d and elsewhere
};

struct EdgeArrays {
  const double* displacement[3];
  const EdgeShares* shares;
  double per_spacing;                  ///< [1/m]
  std::array<std::ptrdiff_t, 3> next;  ///< to the next point along x, y, z
};

/// One compilation's loops (edge_sweeps.cc), with the same bits for all.
struct EdgeLoops {
  /// Finds the packs' moduli.
  void (*find_moduli)(const EdgeArrays& arrays, const EdgeFactors& factors, EdgePack* packs,
                      std::size_t count);
  /// Adds up what cells give to the edges along axis d, of every component.
  void (*add_blocks)(const EdgeArrays& arrays, const EdgePack* packs, std::size_t count,
                     std::size_t d, Single spread, Single* const* edges);
};
template <int width>
const EdgeLoops& edge_loops_at();

}  // namespace fingertip::lattice::inline dynamics::inline scaling::sweeps
