/// How a tie between the rubber and what it touches pushes, for the kernel (packs of ties) and for
/// equilibria (plain doubles).
#pragma once

#include <limits>

#include "meshes/press/obstacle_surface.h"

namespace fingertip::lattice::inline kernels {

/// Push of a tie of stiffness k at rest over k, by its depth d >= 0:
///
///   d (1 + growth d²)    up to `limit`; from there on it goes on in a straight line
///
/// The default is a linear tie. What the numbers come from: model/tie_layer.h.
struct TieLaw {
  double growth = 0.0;                                ///< not negative [1/m²]
  double limit = std::numeric_limits<double>::max();  ///< [m]
};

namespace kernel {

/// Of a tie, over its stiffness at rest: energy [m²], its derivative, the push [m], and the
/// derivative of that [-], which is continuous and grows from 1 to 1 + 3 growth limit²: the energy
/// is convex, whatever the depth.
template <typename Number>
struct TiePush {
  Number energy, length, tangent;

  TiePush(const TieLaw& law, const Number& depth) {
    using meshes::choose;
    const Number limit = law.limit;
    const Number bent = choose(depth < limit, depth, limit), straight = depth - bent;
    const Number grown = law.growth * bent * bent;
    tangent = 1.0 + 3.0 * grown;
    length = bent * (1.0 + grown) + tangent * straight;
    energy = 0.5 * bent * bent * (1.0 + 0.5 * grown) +
             straight * (bent * (1.0 + grown) + 0.5 * tangent * straight);
  }
};

}  // namespace kernel
}  // namespace fingertip::lattice::inline kernels
