/// The loops of a V-cycle, over runs of eight points and three components.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lattice/scaling/grid_hierarchy.h"

/// Compiled for several instruction sets; without sums across lanes, and without contraction to
/// fused multiply-adds, the bits are the same.
#define FINGERTIP_CLONES [[gnu::target_clones("avx512f", "avx2", "default")]]

namespace fingertip::lattice::sweeps {

/// Single precision: what is solved is a correction, and its sums over particles are put right in
/// double precision by who asks for it (mass_scaling.h).
using Single = float;

/// Of one level; fields by component.
struct LevelArrays {
  const Single* edge[3];
  const Single* inertia;
  const Single* relaxation;
  const Single* load[3];
  Single* solution[3];
  Single* residual[3];
  std::ptrdiff_t next[2];  ///< along y and z
};

/// solution = relaxation load
void first_sweep(const LevelArrays& level, const std::uint32_t* blocks, std::size_t count);
/// residual = load - (D + S) solution
void find_residual(const LevelArrays& level, const std::uint32_t* blocks, std::size_t count);
/// residual = solution + relaxation (load - (D + S) solution)
void smooth(const LevelArrays& level, const std::uint32_t* blocks, std::size_t count);

/// Fields of one level and of the sheet between it and the next.
struct TransferArrays {
  Single* fine[3];
  Single* sheet[3];
  Single* coarse[3];
  std::ptrdiff_t next[2];  ///< of the fine level
};

/// sheet = Pᵀ fine along y and z
void gather(const TransferArrays& arrays, const GridLevel::SheetBlock* blocks, std::size_t count);
/// coarse = Pᵀ sheet along x
void contract(const TransferArrays& arrays, const std::uint32_t* coarse_blocks,
              const std::uint32_t* sheets, std::size_t count);
/// sheet = P coarse along x
void stretch(const TransferArrays& arrays, const std::uint32_t* coarse_blocks,
             const std::uint32_t* sheets, std::size_t count);
/// fine += P sheet along y and z
void spread(const TransferArrays& arrays, const std::uint32_t* blocks,
            const std::array<std::uint32_t, 4>* parents, std::size_t count);

}  // namespace fingertip::lattice::sweeps
