/// A triangulated surface: what is asked of it in space, and whether it closes a solid.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "meshes/shape/shape.h"

namespace fingertip::meshes::inline shape {

/// Triangles by the numbers of their vertices [m], counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Vector3> vertices;
  std::vector<std::array<int, 3>> triangles;
  /// Parts of the surface with a name: faces of a CAD solid, solids of an STL text.
  std::vector<std::string> face_names = {};
  std::vector<int> faces = {};  ///< per triangle the number of its own, -1: none; or empty

  const Vector3& corner(std::size_t triangle, std::size_t c) const {
    return vertices[std::size_t(triangles[triangle][c])];
  }
  Vector3 centroid(std::size_t triangle) const {
    return (corner(triangle, 0) + corner(triangle, 1) + corner(triangle, 2)) / 3.0;
  }
  /// Along the outward normal, as long as the triangle's area [m²].
  Vector3 area_vector(std::size_t triangle) const;
  /// The number of the face with this name, which is a new one where there is none; empty: -1.
  int face_number(const std::string& name);
};

/// The mesh with vertices merged that lie within a millionth of its extent, and without the
/// triangles that vanish thereby. Throws InvalidInput (geometry.file; of a wrong unit,
/// geometry.unit) with the place where the surface is not the closed, outward boundary of one body:
/// holes, edges of more than two triangles, points at which it touches itself, triangles turned
/// against their neighbours or all inward, several bodies, an extent outside 0.5 mm ... 0.5 m.
/// Closed cavities within the body are fine.
TriangleMesh closed_surface(const TriangleMesh& mesh);

/// Throws InvalidInput with the place where triangles of such a surface cross each other.
void check_crossings(const TriangleMesh& mesh);

/// Cuts triangles that straddle the plane w[axis] = limit; corners within `grain` [m] lie in it.
/// Pieces have their triangle's face. Returns the new vertices by the ends of the edges they cut,
/// the smaller number first.
std::map<std::pair<int, int>, int> cut_along(TriangleMesh& mesh, int axis, double limit,
                                             double grain);

/// ", or name faces: base, rim", for remedies; nothing without names.
std::string or_faces(const std::vector<std::string>& names);

/// "(x, y, z) = (1, 2, 3) mm"
std::string place_of(const Vector3& w);

/// Search trees over a closed surface.
class TriangleTree {
 public:
  struct Hit {
    double distance = 0.0;  ///< from the place asked for [m]
    Vector3 position = Vector3::Zero();
    std::size_t triangle = 0;
  };

  /// `groups` numbers the group of every triangle, from 0 up to `group_count`.
  TriangleTree(const TriangleMesh& mesh, const std::vector<int>& groups, int group_count);
  ~TriangleTree();
  TriangleTree(const TriangleTree&) = delete;
  TriangleTree& operator=(const TriangleTree&) = delete;

  /// The nearest point of all triangles, or of a group; empty when that has none.
  std::optional<Hit> nearest(const Vector3& w, std::optional<int> group = {}) const;
  /// Within the surface or on it.
  bool contains(const Vector3& w) const;
  /// The first triangle that a ray from `start` along a unit vector meets, besides `except`.
  std::optional<Hit> first_on_ray(const Vector3& start, const Vector3& along,
                                  std::size_t except) const;

 private:
  struct Trees;
  std::unique_ptr<Trees> trees_;
};

}  // namespace fingertip::meshes::inline shape
