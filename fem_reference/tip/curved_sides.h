/// How the sides of a mesh follow the true surface of a finger. deal.II's side.
#pragma once

#include "fem_reference/elements/body.h"

namespace fingertip::fem_reference::inline tip {

/// Faces and edges on the boundary get manifolds: they lie on the parts of `geometry`'s boundary
/// (meshes::BoundaryParts), and so do their nodes of higher degree and the cells that they are
/// refined to. Those at edges that the mesh hides keep to the parabolas of the first mesh through
/// their corners and their middles on the part, or stay flat where a corner is off the part; faces
/// beside an edge of the body that is no parabola are spanned by their lines. In 3D all sides of an
/// element stay flat that they, or those of one of its children, would turn inside out: at fillets
/// that are small beside it. The mesh is the first, not refined, turned about y by -`tilt` [rad].
/// Every process does the same.
template <int dim>
void follow_boundary(Body<dim>& body, const meshes::Geometry& geometry, double tilt);

}  // namespace fingertip::fem_reference::inline tip
