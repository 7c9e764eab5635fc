// All of CGAL: its headers take half a minute to compile.
#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/version.h>
#if CGAL_VERSION_MAJOR < 6
#include <CGAL/AABB_traits.h>
#else
#include <CGAL/AABB_traits_3.h>
#endif
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <cmath>
#include <iterator>
#include <utility>
#include <variant>

#include "meshes/base/errors.h"
#include "meshes/shape/triangle_mesh.h"

namespace fingertip::meshes::inline shape {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;
using Face = SurfaceMesh::Face_index;
using Facet = CGAL::AABB_face_graph_triangle_primitive<SurfaceMesh>;

// From CGAL 6 on traits tell their dimension, and what two figures share is a std::variant.
#if CGAL_VERSION_MAJOR < 6
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Facet>>;
template <class Figure, class Shared>
const Figure* shared_as(const Shared& shared) {
  return boost::get<Figure>(&shared);
}
#else
using Tree = CGAL::AABB_tree<CGAL::AABB_traits_3<Kernel, Facet>>;
template <class Figure, class Shared>
const Figure* shared_as(const Shared& shared) {
  return std::get_if<Figure>(&shared);
}
#endif

Point point_of(const Vector3& w) {
  return {w.x(), w.y(), w.z()};
}
Vector3 vector_of(const Point& p) {
  return {p.x(), p.y(), p.z()};
}

/// Facets by the triangles' numbers.
SurfaceMesh surface_mesh(const TriangleMesh& mesh) {
  SurfaceMesh surface;
  for (const Vector3& vertex : mesh.vertices) surface.add_vertex(point_of(vertex));
  using Vertex = SurfaceMesh::Vertex_index;
  for (const auto& [a, b, c] : mesh.triangles)
    surface.add_face(Vertex(unsigned(a)), Vertex(unsigned(b)), Vertex(unsigned(c)));
  return surface;
}

bool is_line(const TriangleMesh& mesh, std::size_t triangle) {
  return CGAL::collinear(point_of(mesh.corner(triangle, 0)), point_of(mesh.corner(triangle, 1)),
                         point_of(mesh.corner(triangle, 2)));
}

/// Throws the first pair of facets that cross; those without area are told as crossing themselves.
struct Crossing {
  using iterator_category = std::output_iterator_tag;
  using value_type = void;
  using difference_type = std::ptrdiff_t;
  using pointer = void;
  using reference = void;

  Crossing& operator*() { return *this; }
  Crossing& operator++() { return *this; }
  Crossing& operator++(int) { return *this; }
  Crossing& operator=(const std::pair<Face, Face>& pair) {
    if (pair.first != pair.second) throw pair;
    return *this;
  }
};

}  // namespace

void check_crossings(const TriangleMesh& mesh) {
  const SurfaceMesh surface = surface_mesh(mesh);
  if (surface.number_of_faces() != mesh.triangles.size())
    throw InvalidInput({"geometry.file", "", "the surface must be closed and not branch",
                        "mend the mesh in the program that made it"});
  try {
    CGAL::Polygon_mesh_processing::self_intersections<CGAL::Sequential_tag>(surface, Crossing());
  } catch (const std::pair<Face, Face>& pair) {
    throw InvalidInput({"geometry.file",
                        "facets near " + place_of(mesh.centroid(pair.first)) + " and " +
                            place_of(mesh.centroid(pair.second)),
                        "the surface must not cross itself",
                        "unite the parts or mend the mesh in the program that made it"});
  }
}

struct TriangleTree::Trees {
  SurfaceMesh surface;
  Tree all;
  std::vector<std::unique_ptr<Tree>> groups;  ///< null: empty
  std::unique_ptr<CGAL::Side_of_triangle_mesh<SurfaceMesh, Kernel, CGAL::Default, Tree>> side;
};

TriangleTree::TriangleTree(const TriangleMesh& mesh, const std::vector<int>& groups,
                           int group_count)
    : trees_(std::make_unique<Trees>()) {
  trees_->surface = surface_mesh(mesh);
  const SurfaceMesh& surface = trees_->surface;
  // Neighbours have the edges of a facet without area.
  std::vector<Face> faces;
  std::vector<std::vector<Face>> of_group{std::size_t(group_count)};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (is_line(mesh, t)) continue;
    faces.emplace_back(unsigned(t));
    of_group[std::size_t(groups[t])].emplace_back(unsigned(t));
  }
  const auto build = [&](Tree& tree, const std::vector<Face>& list) {
    tree.insert(list.begin(), list.end(), surface);
    tree.build();
    tree.accelerate_distance_queries();
  };
  build(trees_->all, faces);
  for (const std::vector<Face>& list : of_group) {
    trees_->groups.push_back(list.empty() ? nullptr : std::make_unique<Tree>());
    if (!list.empty()) build(*trees_->groups.back(), list);
  }
  trees_->side = std::make_unique<decltype(trees_->side)::element_type>(trees_->all);
}

TriangleTree::~TriangleTree() = default;

std::optional<TriangleTree::Hit> TriangleTree::nearest(const Vector3& w,
                                                       std::optional<int> group) const {
  const Tree* tree = group ? trees_->groups[std::size_t(*group)].get() : &trees_->all;
  if (tree == nullptr) return {};
  const auto [point, face] = tree->closest_point_and_primitive(point_of(w));
  const Vector3 position = vector_of(point);
  return Hit{(position - w).norm(), position, std::size_t(face)};
}

bool TriangleTree::contains(const Vector3& w) const {
  return (*trees_->side)(point_of(w)) != CGAL::ON_UNBOUNDED_SIDE;
}

std::optional<TriangleTree::Hit> TriangleTree::first_on_ray(const Vector3& start,
                                                            const Vector3& along,
                                                            std::size_t except) const {
  const Kernel::Ray_3 ray(point_of(start), Kernel::Vector_3(along.x(), along.y(), along.z()));
  const auto met =
      trees_->all.first_intersection(ray, [&](Face face) { return std::size_t(face) == except; });
  if (!met) return {};
  Vector3 position = start;
  if (const Point* point = shared_as<Point>(met->first))
    position = vector_of(*point);
  else if (const auto* segment = shared_as<Kernel::Segment_3>(met->first))
    position = vector_of(segment->source());
  return Hit{(position - start).norm(), position, std::size_t(met->second)};
}

}  // namespace fingertip::meshes::inline shape
