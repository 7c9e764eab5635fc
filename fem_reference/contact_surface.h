/// The part of the tip's surface that may meet the plane, as nodes. Free of deal.II; every process
/// holds all of it, in the same order whatever their number.
#pragma once

#include <array>
#include <vector>

#include "meshes/geometry.h"

namespace fingertip::fem_reference {

/// A node of the outer surface that can move toward the plane. Hanging nodes are none: they follow
/// their neighbours, which carry their share of the area.
struct SurfaceNode {
  meshes::Vector3 position;       ///< in the reference shape, plane axes [m]
  std::array<long, 3> unknown{};  ///< of its displacement along x, y, z
  std::array<bool, 3> free{};     ///< false where a symmetry plane or the bond holds it
  double area = 0.0;  ///< entry of the lumped (Gauss-Lobatto) surface mass [m²]; 0: a pole
  /// How far a force on it spreads, so that G times this is about its stiffness: sqrt(area) of a
  /// solid's node, the circumference of the ring for which a meridian's stands [m].
  double extent = 0.0;
};

/// The contact unknowns of a press: candidate nodes, and which of their unknowns contact may hold
/// or load.
struct ContactUnknowns {
  std::vector<SurfaceNode> nodes;           ///< candidates
  std::vector<long> unknowns;               ///< numbers in the body's system
  std::vector<std::array<int, 3>> of_node;  ///< per node: position in `unknowns`, -1 if none
};

/// Frictionless contact (`lateral` false) needs the z unknowns only; friction all that are free.
/// Candidates are the nodes above `lowest` [m].
ContactUnknowns contact_unknowns(const std::vector<SurfaceNode>& nodes, bool lateral,
                                 double lowest);

}  // namespace fingertip::fem_reference
