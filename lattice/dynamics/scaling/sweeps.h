/// The loops of a V-cycle, over runs of eight points and three components.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace fingertip::lattice::inline dynamics::inline scaling::sweeps {

/// Single precision: what is solved is a correction, and its sums over particles are put right in
/// double precision by who asks for it (mass_scaling.h).
using Single = float;

/// Eight points of the sheet between a grid and the next (GridLevel).
struct SheetBlock {
  std::uint32_t sheet;  ///< its first point there
  std::uint32_t row;    ///< the point of the finer grid in its middle row
};

/// Of one level; fields by component.
struct LevelArrays {
  const Single* edge[3][3];  ///< by component and axis
  const Single* inertia;
  const Single* relaxation[3];
  const Single* load[3];
  Single* solution[3];
  Single* residual[3];
  std::ptrdiff_t next[2];  ///< along y and z
};

/// Of one level.
struct RelaxationArrays {
  const Single* edge[3][3];  ///< by component and axis
  const Single* inertia;
  Single* relaxation[3];
  Single damping;
  std::ptrdiff_t next[3];
};

/// Of what points or edges have, the parts that go to the coarser ones they lie next to: weights at
/// 2i - 2, 2i - 1, 2i along each axis, and a factor.
struct Weights {
  Single along[3][3], all;
  std::ptrdiff_t next[2];  ///< of the fine level
};

/// Fields of one level and of the sheet between it and the next.
struct TransferArrays {
  Single* fine[3];
  Single* sheet[3];
  Single* coarse[3];
  std::ptrdiff_t next[2];  ///< of the fine level
};

/// One compilation's loops (sweeps.cc): the bits are the same for all, for nothing is summed across
/// lanes or contracted to fused multiply-adds.
struct Loops {
  /// solution = relaxation load
  void (*first_sweep)(const LevelArrays& level, const std::uint32_t* blocks, std::size_t count);
  /// residual = load - (D + S) solution
  void (*find_residual)(const LevelArrays& level, const std::uint32_t* blocks, std::size_t count);
  /// residual = solution + relaxation (load - (D + S) solution)
  void (*smooth)(const LevelArrays& level, const std::uint32_t* blocks, std::size_t count);
  /// relaxation = 1/(D + damping times S's diagonal), 0 where there is no inertia
  void (*find_relaxation)(const RelaxationArrays& level, const std::uint32_t* blocks,
                          std::size_t count);
  /// From points onto the sheet, along y and z
  void (*share_across)(const Weights& weights, const Single* fine, const SheetBlock* blocks,
                       std::size_t count, Single* sheet);
  /// and from there along x.
  void (*share_along)(const Weights& weights, const Single* sheet, const std::uint32_t* sheets,
                      const std::uint32_t* coarse_blocks, std::size_t count, Single* coarse);
  /// sheet = Pᵀ fine along y and z
  void (*gather)(const TransferArrays& arrays, const SheetBlock* blocks, std::size_t count);
  /// coarse = Pᵀ sheet along x
  void (*contract)(const TransferArrays& arrays, const std::uint32_t* coarse_blocks,
                   const std::uint32_t* sheets, std::size_t count);
  /// sheet = P coarse along x
  void (*stretch)(const TransferArrays& arrays, const std::uint32_t* coarse_blocks,
                  const std::uint32_t* sheets, std::size_t count);
  /// fine += P sheet along y and z
  void (*spread)(const TransferArrays& arrays, const std::uint32_t* blocks,
                 const std::array<std::uint32_t, 4>* parents, std::size_t count);
};
template <int width>
const Loops& loops_at();

}  // namespace fingertip::lattice::inline dynamics::inline scaling::sweeps
