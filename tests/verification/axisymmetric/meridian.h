/// The fingertip's meridian as a mesh of quadratic quadrilaterals, for straight presses.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "meshes/shape/geometry.h"

namespace fingertip::verification {

/// How a meridian is divided. Every element of a graded coarse mesh is cut into `parts` x `parts`,
/// so that meshes of different `parts` are nested in shape and their forces can be extrapolated.
struct MeridianOptions {
  int parts = 2;
  double contact_angle = 0.75;   ///< from the pole, divided evenly [rad]
  int contact_elements = 48;     ///< of the coarse mesh, on that angle
  double surface_share = 0.025;  ///< first element at outer surface and bond over R - r
  double largest_share = 0.12;   ///< largest element over R - r
  double growth = 1.25;          ///< of neighbouring elements
};

/// Nodes lie on a grid: `along` of them from the pole to the sleeve's end times `across` of them
/// from the rod to the outer surface, both odd; node (i, j) has number i across + j. Elements have
/// the nine nodes of 3 x 3 grid points.
struct Meridian {
  int along = 0, across = 0;
  std::vector<Eigen::Vector2d> nodes;  ///< (r, z), on the true surfaces [m]
  std::vector<std::array<int, 9>> elements;
  int cap = 0;  ///< outer nodes 0 ... cap lie on the hemisphere, the pole first

  int outer(int i) const { return i * across + across - 1; }
};

Meridian mesh_meridian(const meshes::Geometry& geometry, const MeridianOptions& options);

}  // namespace fingertip::verification
