/// A force on a point of the tip's outer surface.
#pragma once

#include "meshes/shape/geometry.h"

namespace fingertip::lattice::inline contact {

struct PointLoad {
  meshes::Vector3 place = meshes::Vector3::Zero();  ///< of the point [m]
  meshes::Vector3 force = meshes::Vector3::Zero();  ///< of the plane on the tip [N]
};

}  // namespace fingertip::lattice::inline contact
