/// The loops of CarriedRubber, over runs of eight points.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "lattice/dynamics/scaling/sweeps.h"

namespace fingertip::lattice::inline dynamics::inline scaling::sweeps {

/// Fields by component; those that a loop does not name may be null.
struct BodyArrays {
  const std::uint32_t* blocks;
  const std::array<double, 3>* starts;  ///< per block: X of its first point, along the grid's axes
  double spacing;
  const double* displacement[3];
  double *place[3], *velocity[3];  ///< displacement and velocity of particles that move
  const double* mass;
  const double* gain;  ///< inertia of the mass and what hangs on it over the mass
  const Single* acceleration[3];
  const double* force[3];
  Single* load[3];
  const Single* moves;     ///< 1 at particles, else 0
  const Single* share[3];  ///< of a Restraint
};

/// The parts of the patch's acceleration along the restraint's directions.
struct Patch {
  double part[3][3];
};

/// One compilation's loops (body_sweeps.cc), with the same bits for all.
struct BodyLoops {
  /// load = gain force - mass (a + w x x), motion (a, w); over the blocks from `begin` to
  /// `end`
  void (*load)(const BodyArrays& body, std::size_t begin, std::size_t end, const double* motion);
  /// Sixteen sums: of mass * acceleration and its moment, of the mass, its moment, and its second
  /// moments xx, yy, zz, xy, yz, zx.
  void (*sum)(const BodyArrays& body, std::size_t begin, std::size_t end, double* sums);
  /// A step of the particles that ends with the new velocity: v += step (acceleration + a + w x x),
  /// u += step v; motion (a, w). Four sums before: of mass v and of mass v².
  void (*move)(const BodyArrays& body, std::size_t begin, std::size_t end, const double* motion,
               double step, double* sums);
  /// The same, less what is kept of the patch's acceleration: its shares. Six more sums: of mass
  /// times that, and its moment.
  void (*move_restrained)(const BodyArrays& body, std::size_t begin, std::size_t end,
                          const double* motion, const Patch& patch, double step, double* sums);
};
template <int width>
const BodyLoops& body_loops_at();

}  // namespace fingertip::lattice::inline dynamics::inline scaling::sweeps
