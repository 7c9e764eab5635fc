/// The loops of CarriedRubber, over runs of eight points.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "lattice/scaling/sweeps.h"

namespace fingertip::lattice::sweeps {

/// Fields by component; those that a loop does not name may be null.
struct BodyArrays {
  const std::uint32_t* blocks;
  const std::array<double, 3>* starts;  ///< per block: X of its first point, along the grid's axes
  double spacing;
  const double* displacement[3];
  const double* mass;
  const double* inverse_mass;
  const double* inertia;  ///< of the mass and what hangs on it
  const Grain* acceleration[3];
  const double* force[3];
  Grain* load[3];
  double* result[3];
};

/// load = inertia force/mass - mass (a + w x x), motion (a, w); over the blocks from `begin` to
/// `end`
void load(const BodyArrays& body, std::size_t begin, std::size_t end, const double* motion);

/// Six sums: of mass * acceleration, and its moment.
void sum_taken(const BodyArrays& body, std::size_t begin, std::size_t end, double* sums);
/// Ten sums: of the mass, its moment, and its second moments xx, yy, zz, xy, yz, zx.
void sum_inertia(const BodyArrays& body, std::size_t begin, std::size_t end, double* sums);
/// result = mass (acceleration + a + w x x); motion (a, w)
void carry(const BodyArrays& body, std::size_t begin, std::size_t end, const double* motion);

}  // namespace fingertip::lattice::sweeps
