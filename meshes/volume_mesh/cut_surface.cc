// CGAL's triangulations in the plane.
#include "meshes/volume_mesh/cut_surface.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "meshes/base/errors.h"

namespace fingertip::meshes::inline volume_mesh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
/// How many sides lie between a triangle and the outside; -1: not known yet.
struct Depth {
  int sides = -1;
};
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<Depth, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Section = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
    CGAL::No_constraint_intersection_requiring_constructions_tag>;

/// From the outside inward.
void count_sides(const Section& section) {
  std::vector<Section::Face_handle> layer{section.infinite_face()};
  for (int depth = 0; !layer.empty(); ++depth) {
    std::vector<Section::Face_handle> next;
    while (!layer.empty()) {
      const auto face = layer.back();
      layer.pop_back();
      if (face->info().sides >= 0) continue;
      face->info().sides = depth;
      for (int i = 0; i < 3; ++i)
        (face->is_constrained(i) ? next : layer).push_back(face->neighbor(i));
    }
    layer = std::move(next);
  }
}

PartedSurface without_idle_corners(PartedSurface surface) {
  std::vector<int> numbers(surface.mesh.vertices.size(), -1);
  std::vector<Vector3> kept;
  const auto renumber = [&](int& corner) {
    int& number = numbers[std::size_t(corner)];
    if (number < 0) {
      number = int(kept.size());
      kept.push_back(surface.mesh.vertices[std::size_t(corner)]);
    }
    corner = number;
  };
  for (auto& triangle : surface.mesh.triangles) std::ranges::for_each(triangle, renumber);
  for (auto& crease : surface.creases) std::ranges::for_each(crease, renumber);
  surface.mesh.vertices = std::move(kept);
  return surface;
}

}  // namespace

std::vector<std::array<int, 3>> filled(const std::vector<Vector2>& corners,
                                       const std::vector<std::array<int, 2>>& sides) {
  Section section;
  std::vector<Section::Vertex_handle> handles(corners.size());
  for (const auto& side : sides)
    for (const int corner : side) {
      auto& handle = handles[std::size_t(corner)];
      if (handle != Section::Vertex_handle()) continue;
      const Vector2& w = corners[std::size_t(corner)];
      handle = section.insert({w.x(), w.y()});
      handle->info() = corner;
    }
  try {
    for (const auto& [a, b] : sides)
      section.insert_constraint(handles[std::size_t(a)], handles[std::size_t(b)]);
  } catch (const Section::Intersection_of_constraints_exception&) {
    throw NotConverged("the section of the finger could not be filled with triangles");
  }
  count_sides(section);
  std::vector<std::array<int, 3>> triangles;
  for (const auto& face : section.finite_face_handles())
    if (face->info().sides % 2 == 1)
      triangles.push_back(
          {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
  return triangles;
}

PartedSurface positive_side(PartedSurface surface, int axis, double grain, int part) {
  TriangleMesh& mesh = surface.mesh;
  for (Vector3& w : mesh.vertices)
    if (std::abs(w[axis]) <= grain) w[axis] = 0.0;
  mesh.faces = std::move(surface.parts);
  const auto cuts = cut_along(mesh, axis, 0.0, 0.0);
  const auto height = [&](int vertex) { return mesh.vertices[std::size_t(vertex)][axis]; };

  PartedSurface half;
  half.hides_edges = surface.hides_edges;
  half.mesh.vertices = mesh.vertices;
  std::set<std::array<int, 2>> open;  // edges whose other triangle is missing, by their ends
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& triangle = mesh.triangles[t];
    const auto [low, high] = std::ranges::minmax(triangle, {}, height);
    if (height(low) < 0.0 || height(high) <= 0.0) continue;
    half.mesh.triangles.push_back(triangle);
    half.parts.push_back(mesh.faces[t]);
    for (std::size_t c = 0; c < 3; ++c) {
      const int a = triangle[c], b = triangle[(c + 1) % 3];
      if (open.erase({b, a}) == 0) open.insert({a, b});
    }
  }
  std::vector<Vector2> section;
  const int along = (axis + 1) % 3, across = (axis + 2) % 3;
  for (const Vector3& w : mesh.vertices) section.emplace_back(w[along], w[across]);
  for (const auto& [a, b, c] : filled(section, {open.begin(), open.end()})) {
    half.mesh.triangles.push_back({a, c, b});  // the body is above it
    half.parts.push_back(part);
  }
  for (auto [a, b] : surface.creases) {
    if (const auto cut = cuts.find(std::minmax(a, b)); cut != cuts.end())
      (height(a) < 0.0 ? a : b) = cut->second;
    // One along the plane is an edge of its section.
    if (std::min(height(a), height(b)) >= 0.0 && std::max(height(a), height(b)) > 0.0)
      half.creases.push_back({a, b});
  }
  return without_idle_corners(std::move(half));
}

}  // namespace fingertip::meshes::inline volume_mesh
