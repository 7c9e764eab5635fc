/// Interface of the vectorised kernel of the cells: raw arrays only, so that the same source can be
/// compiled for several instruction sets (no inline function of a library is shared with them).
#pragma once

#include <cstddef>

#include "lattice/kernels/cell_material.h"
#include "lattice/kernels/lanes.h"

namespace fingertip::lattice::inline kernels::kernel {

/// What cells of a rubber that relaxes at large strain remember, as functions of C = FᵀF and of the
/// modes seen from the rubber, k = F⁻¹ q: S = 2 dW/dC in the units of force (xx, yy, zz, yz, zx,
/// xy), and dW/dk but for bending, by components and modes.
inline constexpr int remembered = 18;

/// Of a branch since its values were noted: h = decay h + gain times the change.
struct PronyBranch {
  double decay = 0.0, gain = 0.0;
  double later = 0.0;  ///< decay at the end of an interval that begins now
};
/// How all branches together have faded.
struct History {
  const PronyBranch* prony = nullptr;
  int branches = 0;
  /// Within an interval the sum of all branches is share times what drives them plus a part that
  /// hardly bends in time: `first` and `second` times what it was made of when they were noted.
  bool held = false;
  double share = 0.0, first = 1.0, second = 0.0;
  double gain_now = 0.0, gain_later = 0.0;  ///< `share` at both ends of an interval that begins now
  /// Of cells, per block and lane: what drove the branches, their h, and the parts at both ends of
  /// the interval; `remembered` (3 + branches) values. Null: none.
  const Lanes* values = nullptr;
  Lanes* noted = nullptr;  ///< the same, to be brought to the present; null: kept
};

/// Borrowed arrays of a CellLattice and a state; sizes and units as in cell_lattice.h.
struct CellArrays {
  const double* displacement[3];
  const double* velocity[3];  ///< read with rates only
  double* force[3];           ///< added to, at the cells' corners [N]
  const Lanes* cut;
  std::ptrdiff_t row, plane;
  double spacing;
  CellMaterial material;
  History history;  ///< read by `relaxing` sweeps only
};

/// Extremes over cells that a sweep has seen; rest counts among them. The order of sweeps does not
/// matter.
struct CellBounds {
  double smallest_jacobian = 1.0;
  /// network: largest (|G - lambda ln J| + lambda) g [Pa], laws that hold their fibres: that of
  /// cell_hyperelastic.h, volume: J² g (1 + |J - 1|/|J|), with g at least the largest eigenvalue of
  /// F⁻¹F⁻ᵀ (Gershgorin).
  double tangent = 0.0;
  double beyond = 0.0;             ///< laws that hold fibres: what all dF have beyond waves [Pa]
  double viscosity = 1.0;          ///< network: largest g, volume: J² g
  double fastest = 0.0;            ///< largest tau |dJ/dt|/J
  double velocity_gradient = 0.0;  ///< network: largest row sum of tau |dF/dt F⁻¹|
};

/// What enters the forces of cells, and what is found on the way.
enum class CellTask {
  elastic,  ///< displacements alone; `cubic` is always asked so
  damped,   ///< velocities as well
  /// The same, and their energy is summed: `network` alone, whose steps may be so few in a period
  /// (scaled masses) that a sum apart would be felt.
  storing,
  relaxing,  ///< velocities and the past: laws of large strain
};

/// Adds the forces of blocks[begin, end), in their order, and extends `bounds`. Returns what they
/// store [J] if that is asked for, else 0. Two calls at a time must not share a particle.
using CellSweep = double (*)(const CellArrays& arrays, const CellBlock* blocks, std::size_t begin,
                             std::size_t end, CellBounds& bounds);

/// The kernel for a law and a number of doubles per register: 2 (every x86-64), 4 (AVX2), 8
/// (AVX-512), or 0 for the widest the processor has; the caller makes sure that it has the others.
CellSweep select_cells(CellLawKind law, CellTask task, int width);

/// Energy of blocks[0, count) [J], forces and velocities are not looked at; infinite where the law
/// needs J > 0 and has not got it. The same bits for any width.
using CellEnergy = double (*)(const CellArrays& arrays, const CellBlock* blocks, std::size_t count);
CellEnergy select_cell_energy(CellLawKind law, int width);

/// Those of one compilation (cell_kernel_widths.cc).
template <int width>
CellSweep cells_at(CellLawKind law, CellTask task);
template <int width>
CellEnergy cell_energy_at(CellLawKind law);

}  // namespace fingertip::lattice::inline kernels::kernel
