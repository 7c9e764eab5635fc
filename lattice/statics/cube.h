/// A free cube of lattice, for virtual material tests (tension, shear) in calibration.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "lattice/model/constants.h"

namespace fingertip::lattice::inline statics {

/// n x n x n whole cells, free on all sides, in small kinematics.
struct CubeLattice {
  /// Rest positions [m] of the (n+1)³ particles, x fastest; the cube is [0, n a]³.
  std::vector<Eigen::Vector3d> positions;
  /// Symmetric K [N/m] of springs and cells, both triangles, 3 (n+1)³ square; degree of freedom
  /// 3 p + c is the displacement of particle p along axis c, the force on the particles is -K u.
  Eigen::SparseMatrix<double> stiffness;
  double spacing = 0.0;  ///< a [m]
  int cells = 0;         ///< n
};

/// The cube as the given model builds it: `published` puts a full spring between every pair of
/// neighbours; `central` and `hookean` add up what the cells own (k1/4 of each edge, k2/2 of each
/// face diagonal, k3 of each body diagonal, and the volume term, zero for central). Stiffness is
/// linear in the constants. Throws InvalidInput unless spacing > 0 and cells >= 1.
CubeLattice cube_lattice(ModelKind kind, const SpringConstants& constants, double spacing,
                         int cells);

}  // namespace fingertip::lattice::inline statics
