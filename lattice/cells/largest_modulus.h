/// How stiff a cell at rest is at most.
#pragma once

#include <algorithm>

#include "lattice/cells/cell_material.h"

namespace fingertip::lattice {

/// Largest eigenvalue of d²W/dF² at rest, of laws `cubic` and `network` [Pa]: of dilatation, of the
/// two shears along the axes and of the three between them.
inline double largest_modulus(const CellMaterial& m) {
  if (m.kind == CellLawKind::cubic) {
    return std::max({m.c11 + 2.0 * m.c12, m.c11 - m.c12, 2.0 * m.c44});
  }
  return std::max(3.0 * m.lambda, 0.0) + 2.0 * m.shear;
}

}  // namespace fingertip::lattice
