/// Where the contact of a press ends. Free of deal.II.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem_reference/job/press_state.h"

namespace fingertip::fem_reference::inline press {

/// A node that the obstacle pushes, seen along the press.
struct PushedNode {
  Eigen::Vector2d place;  ///< from the contact's centre; on a meridian along its first axis [m]
  double pressure = 0.0;  ///< [Pa]
  double force = 0.0;     ///< along the press [N]
  double area = 0.0;      ///< for which it stands, seen along the press [m²]
};

/// Nodes of which contact: `sectors` times as many stand around it.
struct PushedNodes {
  std::vector<PushedNode> nodes{};
  int sectors = 1;        ///< of a part: 2, y >= 0, or 4, x, y >= 0
  bool meridian = false;  ///< a node is a ring
  double spacing = 0.0;   ///< of nodes around the edge [m]
};

/// Radius of the circle that has the contact's area [m].
///
/// Pressure vanishes at the edge like the square root of the distance, as in Hertz's p² ∝ 1 - s. Of
/// a contact of any tilt s = xᵀ S^-1 x, x from the centre of the forces, S their second moments; on
/// a meridian s = r². The edge is the zero of a parabola in s fitted to p² over the outermost
/// nodes, and the area that of its ellipse. It is kept within a node spacing of the radius that the
/// nodes' own area has, which alone tells where there are few of them, and of several pads, rings
/// and the faces of blocks.
double contact_radius(const PushedNodes& contact);

/// Notes the nodes in a state whose normal force is known, by increasing radius, and tells radius,
/// area, mean and largest pressure.
void measure_contact(PressState& state, const PushedNodes& contact);

}  // namespace fingertip::fem_reference::inline press
