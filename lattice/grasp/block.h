/// The rigid block that two fingers grasp.
#pragma once

#include <array>
#include <vector>

#include "lattice/model/plane.h"
#include "lattice/model/rod.h"
#include "meshes/base/errors.h"

namespace fingertip::lattice::inline grasp {

/// A box of `width` between the fingers (x) and square faces of `height` (y, z). The faces that the
/// fingers touch are treated as endless planes.
struct BlockSettings {
  double mass = 5.0e-3;    ///< [kg], > 0
  double width = 2.0e-2;   ///< [m], > 0
  double height = 3.0e-2;  ///< [m], > 0
  /// Of the centre of mass from the box's centre [m], inside the box.
  meshes::Vector3 eccentricity = meshes::Vector3::Zero();

  std::vector<meshes::Violation> violations() const;
};

/// Mass properties in the box's own axes, origin at the box's centre. An eccentric mass shifts the
/// homogeneous box's tensor as it is.
RodBody block_body(const BlockSettings& settings);

/// The two fingers: the first touches the face at -width/2, the second that at +width/2.
inline constexpr std::array<double, 2> sides{-1.0, 1.0};

/// Outward normal of a face in world axes.
inline meshes::Vector3 face_normal(const RodState& block, double side) {
  return block.pose().orientation * meshes::Vector3(side, 0.0, 0.0);
}

/// A face of the block, with the block's motion, as the plane of a finger whose frame stands at
/// `base` in the world.
Plane face_plane(const BlockSettings& settings, const RodState& block, double side,
                 const Pose& base);

}  // namespace fingertip::lattice::inline grasp
