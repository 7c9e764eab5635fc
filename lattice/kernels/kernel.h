/// Interface of the vectorised force kernel: raw arrays only, so that the same source can be
/// compiled for several instruction sets (no inline function of a library is shared with them).
#pragma once

#include <cstddef>
#include <cstdint>

#include "lattice/kernels/stencil.h"

namespace fingertip::lattice::inline kernels::kernel {

/// Borrowed arrays of a LatticeModel and a state; sizes and units as in model.h.
struct Arrays {
  const double* displacement[3];
  const double* velocity[3];
  const double* weight[13];
  double* force[3];  ///< written at every point of the blocks [N]
  std::ptrdiff_t neighbour[13];
  double spacing;
  double stiffness[3], damping[3];
};

/// Which force law. `rates`: whether velocities enter; without, the displacement handed over is
/// u + tau v (small kinematics with proportional damping: one pass does both).
struct Variant {
  bool finite = false;
  bool rates = true;
};

/// Forces of springs on the points of blocks[begin, end), which follow one another in the grid's
/// order. No two calls write the same place, and the result does not depend on how blocks are
/// shared out. At finite kinematics a spring is evaluated once, at the point that comes first, with
/// those of the plane before blocks[begin] once more; `pulls` is scratch of this call alone,
/// pulls_size() numbers. At small kinematics each point evaluates its own, and there is no scratch.
using SpringForces = void (*)(const Arrays&, const std::uint32_t* blocks, std::size_t begin,
                              std::size_t end, double* pulls);
/// For two planes of `plane` points, three steps along x and three components.
constexpr std::size_t pulls_size(std::ptrdiff_t plane) {
  return 18 * (std::size_t(plane) + 2 * lanes);
}

/// Borrowed arrays for moving the particles through one time step.
struct Motion {
  const double* force[3];
  const double* mass;
  const double* inverse_mass;
  double* displacement[3];
  double* velocity[3];
  double step;      ///< [s]
  bool symplectic;  ///< whether displacements take the new velocity
};

/// v += f/m dt and x += v dt on the points of blocks[begin, end); `momentum` receives their sum of
/// m v before the step. Points of no mass stay where they are.
using MoveParticles = void (*)(const Motion&, const std::uint32_t* blocks, std::size_t begin,
                               std::size_t end, double momentum[3]);

/// The kernel for this variant and a number of doubles per register: 2 (every x86-64), 4 (AVX2), 8
/// (AVX-512), or 0 for the widest the processor has; the caller makes sure that it has the others.
SpringForces select(const Variant& variant, int width = 0);
MoveParticles select_move(int width = 0);

/// Those of one compilation (kernel_widths.cc).
template <int width>
SpringForces springs_at(const Variant& variant);
template <int width>
MoveParticles move_at();

}  // namespace fingertip::lattice::inline kernels::kernel
