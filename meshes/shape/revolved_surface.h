/// The surface of a body of revolution as triangles.
#pragma once

#include <functional>
#include <vector>

#include "meshes/shape/meridian.h"
#include "meshes/shape/triangle_mesh.h"

namespace fingertip::meshes::inline shape {

/// A meridian as chords: a closed polygon (r, z) [m], counter-clockwise; what lies on the axis but
/// for round-off has r = 0.
struct MeridianPolygon {
  std::vector<Vector2> corners;
  std::vector<int> pieces;  ///< per side, from its corner to the next: the piece that it stands for
};
/// `chords`: into how many equal steps of its parameter a piece is divided; those on the axis are
/// one side.
MeridianPolygon chords_of(const Meridian& meridian,
                          const std::function<int(const MeridianPiece&)>& chords);

/// Bands that the sides of a polygon sweep, rubber on their inside; sides on the axis sweep none.
struct SweptPolygon {
  TriangleMesh mesh;        ///< every corner once
  std::vector<int> pieces;  ///< per triangle
  /// Per corner of the polygon its vertices at the angles 0 ... turns; on the axis all the same.
  std::vector<std::vector<int>> rings;
};
/// Swept through `turns` of `sectors` equal angles around the axis, from x toward y; from 0 to 1/4,
/// 1/2 and all of a turn it ends exactly on the planes x = 0 and y = 0, and where it began.
SweptPolygon swept(const MeridianPolygon& polygon, int sectors, int turns);

/// Its corners lie on the surface, in rings around the axis, so that it is inscribed where the
/// finger is convex. Around the axis chords are 5e-4 of the radius high, along the meridian 1e-4 of
/// the largest radius where it may touch, which is what depth is counted from, and 5e-4 elsewhere:
/// 20 000 triangles of the paper's dome.
TriangleMesh revolved_surface(const Meridian& meridian);

/// How far a surface is from the one that it stands for.
struct SurfaceDeviation {
  double largest = 0.0;  ///< distance of the facets' and edges' middles [m]
  double volume = 0.0;   ///< enclosed volume over the true one, minus 1
};
SurfaceDeviation deviation(const TriangleMesh& mesh, const Shape& truth);

}  // namespace fingertip::meshes::inline shape
