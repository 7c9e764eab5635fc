/// Virtual material tests: a finite cube of the lattice, loaded by tractions on all six faces.
#pragma once

#include "lattice/statics/cube.h"

namespace fingertip::calibration::inline moduli {

/// What a testing machine would report for the cube; SI. Strains are volume averages.
struct CubeModuli {
  double youngs_modulus_100 = 0.0;  ///< tension along a cube axis [Pa]
  double youngs_modulus_110 = 0.0;  ///< tension along a face diagonal [Pa]
  double youngs_modulus_111 = 0.0;  ///< tension along a body diagonal [Pa]
  double shear_modulus = 0.0;       ///< sigma_xy/(2 eps_xy) under simple shear stress [Pa]
  double poissons_ratio_100 = 0.0;  ///< -eps_yy/eps_xx under tension along x
  double bulk_modulus = 0.0;        ///< K = stress / (3 tr eps) under tension along x [Pa]
};

/// Loads `cube` by the uniform stresses of the four tests: every surface cell face passes a quarter
/// of its traction sigma·n a² to each of its corners. The static problem is solved by a sparse
/// Cholesky factorisation with the six rigid motions held by six supports that carry no load (the
/// tractions balance), and the mean strain 1/V ∮ ½(u⊗n + n⊗u) dA is read from the surface.
/// Throws NotConverged when the cube has a mechanism besides the rigid motions: a load on it has
/// no equilibrium.
CubeModuli measure_cube(const lattice::CubeLattice& cube);

}  // namespace fingertip::calibration::inline moduli
