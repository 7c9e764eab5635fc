/// A finger of linear tetrahedra, as simulators of deformable bodies have it, pressed by a plane:
/// what such a body answers can be predicted without the simulator.
///
/// Energy density of St. Venant and Kirchhoff, mu E:E + lambda/2 (tr E)² with Green's strain E,
/// constant within a tetrahedron: MuJoCo's `elasticity` of a flex, SOFA's hyperelastic tetrahedra
/// with `StVenantKirchhoff`. Such tetrahedra are too stiff, the more the coarser and the less
/// compressible they are.
#pragma once

#include <vector>

#include "meshes/shape/geometry.h"
#include "meshes/volume_mesh/tetrahedra.h"

namespace fingertip::calibration::inline contact_laws {

struct TetrahedralBody {
  meshes::Tetrahedra mesh;  ///< lengths in metres
  std::vector<bool> held;   ///< vertices of the bond

  double volume() const;  ///< [m³]
  double top() const;     ///< largest z of a vertex [m]
};

/// Edges about as long as `size` [m], at the pole 0.4 of it. Throws InvalidInput for an invalid
/// geometry, NotConverged where no mesh of that size exists.
TetrahedralBody tetrahedral_body(const meshes::Geometry& geometry, double size);

/// A frictionless plane that comes down on a body of Young's modulus 1.
struct TetrahedralPress {
  double poissons_ratio = 0.3;  ///< 0 ... 0.499
  /// Force of a vertex behind the plane over its depth and over Young's modulus [m].
  double contact_stiffness = 0.0;
};

/// Forces over Young's modulus [m²] at increasing indentations [m] after the plane has touched the
/// top, at rest; fewer where a press finds no equilibrium: that law has no resistance to strong
/// compression.
std::vector<double> forces_of(const TetrahedralBody& body, const TetrahedralPress& press,
                              const std::vector<double>& indentations);

}  // namespace fingertip::calibration::inline contact_laws
