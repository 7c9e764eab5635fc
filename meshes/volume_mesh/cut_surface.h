/// Surfaces of the parts that mirror planes leave of a body.
#pragma once

#include <array>
#include <vector>

#include "meshes/volume_mesh/tetrahedra.h"

namespace fingertip::meshes::inline volume_mesh {

/// Corners, by number, of the triangles that fill what closed polygons enclose; where these lie
/// within each other, every other ring. `sides`: of all polygons, by their ends, in any order.
/// Triangles are counter-clockwise. Throws NotConverged where sides cross.
std::vector<std::array<int, 3>> filled(const std::vector<Vector2>& corners,
                                       const std::vector<std::array<int, 2>>& sides);

/// The closed surface of what lies at w[axis] >= 0 (axis 0: x, 1: y). Corners within `grain` [m] of
/// the plane are moved onto it; what closes the surface there is `part`.
PartedSurface positive_side(PartedSurface surface, int axis, double grain, int part);

}  // namespace fingertip::meshes::inline volume_mesh
