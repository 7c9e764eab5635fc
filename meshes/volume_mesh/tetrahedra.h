/// Tetrahedra within a closed surface of triangles, by CGAL.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "meshes/shape/triangle_mesh.h"

namespace fingertip::meshes::inline volume_mesh {

/// A closed surface whose triangles belong to parts, numbered from 0. Borders between parts are
/// edges of the body's, which a mesh of it has, too.
struct PartedSurface {
  TriangleMesh mesh;
  std::vector<int> parts;  ///< of the triangles
  /// Edges at which a part turns sharply into itself, by their ends; a mesh has them, too.
  std::vector<std::array<int, 2>> creases = {};
  /// Of the body's own parts, whether they have edges within that a mesh need not have. Those of
  /// larger numbers are planes that cut it; none where this is empty.
  std::vector<bool> hides_edges = {};

  bool cuts(int part) const {
    return !hides_edges.empty() && std::size_t(part) >= hides_edges.size();
  }
  bool may_hide(int part) const {
    return std::size_t(part) < hides_edges.size() && hides_edges[std::size_t(part)];
  }
};

/// An edge between two parts.
struct PartBorder {
  std::array<int, 2> ends;   ///< vertices
  std::array<int, 2> parts;  ///< on its sides
};

/// All of them, each once.
std::vector<PartBorder> borders_of(const PartedSurface& surface);

/// Wanted length of edges at a place [m].
using SizeField = std::function<double(const Vector3&)>;

struct Tetrahedra {
  struct Facet {
    std::array<int, 3> corners{};
    int part = 0;
  };
  std::vector<Vector3> vertices;               ///< on the surface or within [m]
  std::vector<std::array<int, 4>> tetrahedra;  ///< positively oriented
  std::vector<Facet> facets;                   ///< the boundary, in any sense
};

/// How an edge of the body is divided: all of it nearly as finely as its ends, or as the size field
/// says.
enum class EdgeSizes { as_ends, by_field };

/// The same for the same input. Its surface keeps within `distance` [m] of the triangles. Throws
/// NotConverged when it would take millions of tetrahedra, or none is of such a size.
Tetrahedra tetrahedra_within(const PartedSurface& surface, const SizeField& size, double distance,
                             EdgeSizes edge_sizes = EdgeSizes::as_ends);

}  // namespace fingertip::meshes::inline volume_mesh
