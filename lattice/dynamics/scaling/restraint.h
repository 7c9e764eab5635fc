/// How far the plane keeps the rubber from following the rod.
#pragma once

#include <array>
#include <vector>

#include "lattice/dynamics/scaling/sweeps.h"
#include "lattice/model/rod.h"

namespace fingertip::lattice::inline dynamics::inline scaling {

using sweeps::Single;

/// Of what the rod accelerates the patch by, the share that the plane keeps from a particle: 0 at
/// the bond, 1 on the patch, in between what the rubber's inertia S against deformation makes of
/// it. Nothing is kept of how the rod turns about the patch: S does not resist that, and the patch
/// little.
struct Restraint {
  std::array<std::vector<Single>, 3> share;  ///< per point, for `directions`

  /// Unit vectors: the plane's normal, and two in the plane, as near to the grid's axes as may be,
  /// for S is another for each of them.
  std::array<meshes::Vector3, 3> directions{};

  // Of the present step.
  bool holds = false;                                ///< whether there is any
  meshes::Vector3 centre = meshes::Vector3::Zero();  ///< of the patch [m]
  Matrix6 inertia = Matrix6::Zero();                 ///< that the rod feels, about the origin

  /// What the shares were found for.
  struct Ground {
    double along = 0.0, tangential = 0.0;  ///< sums of the plane's inertia [kg]
    double edges = 0.0;                    ///< a measure of S [kg]
    meshes::Vector3 patch = meshes::Vector3::Zero(), normal = meshes::Vector3::Zero();  ///< at rest
  };
  Ground found;
};

}  // namespace fingertip::lattice::inline dynamics::inline scaling
