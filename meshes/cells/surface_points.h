/// Quadrature points on the tip's true surfaces, which carry contact and bond.
#pragma once

#include <vector>

#include "meshes/shape/geometry.h"

namespace fingertip::meshes::inline cells {

/// Quadrature of one of the surfaces (of the rubber's, not the axis) by rings about the axis. Rings
/// are at most `spacing` [m] wide and so are the steps along them; no point of the surface is
/// farther than 0.75 spacing from the nearest quadrature point. Patches have equal areas within a
/// ring, 0.38 ... 1 spacing² where the surface is many spacings wide, the smallest at the pole,
/// around which lie eight points. The points are their own mirror images under x -> -x, y -> -y and
/// x <-> y, none on a mirror plane. Sums of areas are exact, and so are those of z and of the
/// normal (arcs about the axis, cylinders) and of x² and y² (planes, cones); integrals of other
/// smooth functions converge at second order. Points run ring by ring away from the pole (`free` of
/// the dome: from the bond outward). Of a solid, facets with edges longer than `spacing` are halved
/// until they are not, and what lies in one cube of half that size and faces the same way is one
/// point, in its middle: sums of areas and of first moments are exact, that of the normal where
/// facets are flat, and points may lie anywhere. Throws InvalidInput for an invalid geometry and
/// unless R/1000 <= spacing <= R.
std::vector<SurfacePoint> surface_points(const Geometry& geometry, ProfileSurface surface,
                                         double spacing);

/// Area of one of the surfaces [m²], of the dome 2π s (s + L) with s = R (contact) or r (bond),
/// π (R² - r²) (free). Throws InvalidInput for an invalid geometry.
double surface_area(const Geometry& geometry, ProfileSurface surface);

}  // namespace fingertip::meshes::inline cells
