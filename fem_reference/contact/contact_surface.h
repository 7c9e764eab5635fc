/// The part of the tip's surface that may meet the plane, as nodes. Free of deal.II; every process
/// holds all of it, in the same order whatever their number.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "meshes/press/press_protocol.h"
#include "meshes/shape/geometry.h"

namespace fingertip::fem_reference::inline contact {

/// A node of the outer surface that can move toward the plane. Hanging nodes are none: they follow
/// their neighbours, which carry their share of the area.
struct SurfaceNode {
  meshes::Vector3 position;       ///< in the reference shape, plane axes [m]
  std::array<long, 3> unknown{};  ///< of its displacement along x, y, z
  std::array<bool, 3> free{};     ///< false where a symmetry plane or the bond holds it
  double area = 0.0;  ///< entry of the lumped (Gauss-Lobatto) surface mass [m²]; 0: a pole
  /// Its area over its width: sqrt(area) of a solid's node, the circumference of the ring for which
  /// a meridian's stands [m].
  double extent = 0.0;
};

/// The contact unknowns of a press: candidate nodes, and which of their unknowns contact may hold
/// or load.
struct ContactUnknowns {
  std::vector<SurfaceNode> nodes;           ///< candidates
  std::vector<long> unknowns;               ///< numbers in the body's system
  std::vector<std::array<int, 3>> of_node;  ///< per node: position in `unknowns`, -1 if none
};

/// The unit vectors, as rows, along which the unknowns of a node count.
struct NodeAxes {
  std::array<long, 3> unknown{-1, -1, -1};  ///< of its displacement along x, y, z; -1 if none
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
};

/// The nodes that the obstacle of a press would come to, were it to go on by `reach` [m] from where
/// it first touches, whatever its place along the lateral motion. `height` is that of its top then.
std::vector<SurfaceNode> within_reach(const std::vector<SurfaceNode>& nodes,
                                      const meshes::PressProtocol& protocol, double height,
                                      double reach);

/// All nodes given. Frictionless contact (`lateral` false) with what is flat needs the z unknowns
/// only; other contact all that are free.
ContactUnknowns contact_unknowns(const std::vector<SurfaceNode>& nodes, bool lateral);

}  // namespace fingertip::fem_reference::inline contact
