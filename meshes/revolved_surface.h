/// The surface of a body of revolution as triangles.
#pragma once

#include "meshes/meridian.h"
#include "meshes/triangle_mesh.h"

namespace fingertip::meshes {

/// Its corners lie on the surface, in rings around the axis, so that it is inscribed where the
/// finger is convex. Around the axis chords are 5e-4 of the radius high, along the meridian 1e-4 of
/// the largest radius where it may touch, which is what depth is counted from, and 5e-4 elsewhere:
/// 20 000 triangles of the paper's dome. Neighbours repeat their corners, as in an STL file.
TriangleMesh revolved_surface(const Meridian& meridian);

/// How far a surface is from the one that it stands for.
struct SurfaceDeviation {
  double largest = 0.0;  ///< distance of the facets' and edges' middles [m]
  double volume = 0.0;   ///< enclosed volume over the true one, minus 1
};
SurfaceDeviation deviation(const TriangleMesh& mesh, const Shape& truth);

}  // namespace fingertip::meshes
