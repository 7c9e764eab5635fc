/// Interface of the vectorised kernels of the bond: raw arrays only, as in kernel.h.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lattice/kernels/lanes.h"

namespace fingertip::lattice::inline kernels::kernel {

/// Borrowed arrays of a TiedBond and a state. Particles of the bond come in slices of `lanes`, each
/// a row of the matrix K; those that fill up the last slice have mass 1, no ties and `point` 0.
/// The rows of a slice share one list of columns, the union of theirs: a column's slip is read once
/// for eight rows and nothing is gathered.
struct BondArrays {
  const double* displacement[3];  ///< per grid point, along the grid's axes [m]
  const double* velocity[3];      ///< [m/s]
  double* force[3];               ///< [N]
  const std::uint32_t* point;     ///< grid index per particle of the bond
  const double* rest[3];          ///< X_i along the grid's axes [m]
  const double* mass;             ///< [kg]
  const double* sum;              ///< d_i = Σ_j |K_ij| [N/m]
  const std::uint32_t* first;   ///< per slice: of its columns, an even number; one more at the end
  const std::uint32_t* column;  ///< number of a particle of the bond
  const Lanes* value;           ///< K_ij of the slice's rows, 0 where there is none [N/m]
  double* slip[3];              ///< per particle of the bond [m]
  const double* still[3];       ///< the same at the present place, where the energy is asked for
};

/// Where a rigid rod carries a point X, less X itself: turn X + shift; row by row.
struct Carried {
  double turn[9];
  double shift[3];
};

/// Force on the rod and its moment about the grid's frame, along the grid's axes.
struct Pulled {
  double force[3];
  double moment[3];
  double energy;  ///< [J]
};

/// What the file compiled for one register width offers. Each works on slices [begin, end); two
/// calls at a time never write the same place, and the bits do not depend on the register width.
struct BondKernels {
  /// slip = u + ahead v - carried.
  void (*find_slips)(const BondArrays&, const Carried&, double ahead, std::size_t begin,
                     std::size_t end);
  /// slip·K slip/2 [J].
  double (*energy)(const BondArrays&, std::size_t begin, std::size_t end);
  /// force becomes m/(m + square d) (force - K slip); the sum of what the particles did not get of
  /// it is returned. `square` [s²].
  Pulled (*take)(const BondArrays&, double square, std::size_t begin, std::size_t end);
  /// The same, and still·K still/2.
  Pulled (*take_and_sum)(const BondArrays&, double square, std::size_t begin, std::size_t end);
};

/// For 2, 4 or 8 doubles per register, the caller makes sure that the processor has it, or 0 for
/// the widest that it has.
const BondKernels& select_bond(int width);

/// That of one compilation (bond_kernel_widths.cc).
template <int width>
const BondKernels& bond_at();

}  // namespace fingertip::lattice::inline kernels::kernel
