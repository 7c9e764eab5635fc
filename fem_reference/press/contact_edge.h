/// Where the contact of a press ends. Free of deal.II.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem_reference/contact/plane_contact.h"
#include "fem_reference/job/press_state.h"

namespace fingertip::fem_reference::inline press {

/// Nodes that the obstacle pushes: `sectors` times as many stand around the contact.
struct PushedNodes {
  std::vector<meshes::ContactPoint> nodes{};
  int sectors = 1;        ///< of a part: 2, y >= 0, or 4, x, y >= 0
  bool meridian = false;  ///< a node is a ring about the z axis
  double spacing = 0.0;   ///< of nodes around the edge [m]
};

/// The nodes that touch, `moved` from rest and standing for areas seen along the press [m²]: what a
/// pole bears, which has no area, its neighbour does. Of a meridian `squares` are its mean_squares,
/// and the pole is a place without area, under the pressure that the rings around it tell.
std::vector<meshes::ContactPoint> pushed_nodes(const PlaneContact& contact,
                                               const std::vector<meshes::Vector3>& moved,
                                               const std::vector<double>& seen,
                                               const std::vector<double>& squares = {});

/// Radius of the circle that has the contact's area [m].
///
/// Pressure vanishes at the edge like the square root of the distance, as in Hertz's p² ∝ 1 - s. Of
/// a contact of any tilt s = xᵀ S^-1 x, x from the centre of the forces, S their second moments; on
/// a meridian s = r². The edge is the zero of a parabola in s fitted to p² over the outermost
/// nodes, and the area that of its ellipse. It is kept within a node spacing of the radius that the
/// nodes' own area has, which alone tells where there are few of them, and of several pads, rings
/// and the faces of blocks.
double contact_radius(const PushedNodes& contact);

/// Notes the nodes, all around, in a state whose normal force is known, and tells radius, area,
/// mean and largest pressure, that of a node.
void measure_contact(PressState& state, const PushedNodes& contact);

}  // namespace fingertip::fem_reference::inline press
