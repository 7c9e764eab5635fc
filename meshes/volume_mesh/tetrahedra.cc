// All of CGAL's mesher: its headers take a minute to compile.
#include "meshes/volume_mesh/tetrahedra.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polyhedral_mesh_domain_with_features_3.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/make_mesh_3.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "meshes/base/errors.h"

namespace fingertip::meshes::inline volume_mesh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;
using Domain = CGAL::Polyhedral_mesh_domain_with_features_3<Kernel, SurfaceMesh>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index,
                                                        Domain::Curve_index>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;
using Polyline = std::vector<Point>;

/// Radius over edge of a regular tetrahedron; those made are somewhat smaller than the bound.
constexpr double radius_over_size = 0.7;
constexpr double min_facet_angle = 25.0;  ///< [degrees]
constexpr double radius_over_edge = 2.0;
/// Dihedral angles up to which vertices are moved to open them [degrees].
constexpr double sliver_angle = 18.0;
/// The mesher may ask this often for the size at an edge of the body; for a million tetrahedra it
/// does not.
constexpr long max_questions = 20'000;
/// An edge of the body that turns by more than this has a corner there (cosine).
constexpr double corner_cosine = 0.7;
/// Corners of edges are not nearer to each other, over the extent of the body: elements as small as
/// a step of round-off between two parts would be countless.
constexpr double corners_apart = 1e-3;

Point point_of(const Vector3& w) {
  return {w.x(), w.y(), w.z()};
}

SurfaceMesh surface_mesh(const PartedSurface& surface) {
  SurfaceMesh mesh;
  for (const Vector3& vertex : surface.mesh.vertices) mesh.add_vertex(point_of(vertex));
  auto part = get(CGAL::face_patch_id_t<int>(), mesh);
  using Vertex = SurfaceMesh::Vertex_index;
  for (std::size_t t = 0; t < surface.parts.size(); ++t) {
    const auto& [a, b, c] = surface.mesh.triangles[t];
    const auto face = mesh.add_face(Vertex(unsigned(a)), Vertex(unsigned(b)), Vertex(unsigned(c)));
    put(part, face, surface.parts[t] + 1);  // CGAL's zero is no part
  }
  return mesh;
}

/// The borders between parts and the creases within them, from corner to corner or closed.
class Borders {
 public:
  explicit Borders(const PartedSurface& surface) : surface_(surface) {
    for (const PartBorder& border : borders_of(surface)) {
      add(border.ends[0], border.ends[1]);
      for (const int end : border.ends)
        meeting_[end].insert(border.parts.begin(), border.parts.end());
    }
    for (const auto& [a, b] : surface.creases) add(a, b);
    Eigen::AlignedBox3d box;
    for (const Vector3& w : surface.mesh.vertices) box.extend(w);
    apart_ = corners_apart * box.diagonal().norm();
    for (const auto& [vertex, others] : next_) corners_[vertex] = turns(vertex, others);
  }

  std::vector<Polyline> polylines() {
    std::vector<Polyline> lines;
    for (const auto& [vertex, others] : next_) {
      if (!corners_.at(vertex)) continue;
      while (!next_.at(vertex).empty()) lines.push_back(line_from(vertex));
    }
    for (const auto& [vertex, others] : next_)  // those without a corner
      if (!next_.at(vertex).empty()) lines.push_back(line_from(vertex));
    return lines;
  }

 private:
  void add(int a, int b) {
    next_[a].insert(b);
    next_[b].insert(a);
  }

  const Vector3& at(int vertex) const { return surface_.mesh.vertices[std::size_t(vertex)]; }

  /// Whether a line ends there.
  bool turns(int vertex, const std::set<int>& others) const {
    if (others.size() != 2) return true;
    const auto parts = meeting_.find(vertex);
    if (parts != meeting_.end() && parts->second.size() == 2 &&
        surface_.may_hide(*parts->second.begin()) && surface_.cuts(*parts->second.rbegin()))
      return false;  // a mirror plane cuts an edge that the mesh need not have
    const auto one = beside(vertex, *others.begin()), other = beside(vertex, *others.rbegin());
    if (!one || !other) return false;
    return -one->dot(*other) < corner_cosine * one->norm() * other->norm();
  }

  /// The way along a line to its first vertex that is not near; none where a corner lies before.
  std::optional<Vector3> beside(int vertex, int next) const {
    for (int before = vertex, here = next;;) {
      const Vector3 way = at(here) - at(vertex);
      if (way.norm() > apart_) return way;
      const auto& others = next_.at(here);
      const auto known = corners_.find(here);
      if (here == vertex || others.size() != 2 || (known != corners_.end() && known->second))
        return {};
      before = std::exchange(here, *others.begin() == before ? *others.rbegin() : *others.begin());
    }
  }

  /// Takes the edges it goes along.
  Polyline line_from(int start) {
    Polyline line{point_of(at(start))};
    for (int here = start;;) {
      const int there = *next_.at(here).begin();
      next_.at(here).erase(there);
      next_.at(there).erase(here);
      line.push_back(point_of(at(there)));
      here = there;
      if (here == start || corners_.at(here)) return line;
    }
  }

  const PartedSurface& surface_;
  double apart_ = 0.0;                           ///< least distance of corners [m]
  std::map<int, std::set<int>> next_, meeting_;  ///< neighbours; parts
  std::map<int, bool> corners_;                  ///< where a line ends, before edges were taken
};

struct Sizes {
  using FT = Kernel::FT;
  using Index = Domain::Index;
  const SizeField* size;
  double factor;
  long* asked;
  FT operator()(const Point& p, int dimension, const Index&) const {
    // CGAL goes on for hours where edges come near each other or turn in tiny steps.
    if (dimension < 2 && ++*asked > max_questions)
      throw NotConverged(
          "the finger cannot be filled with tetrahedra of a sensible number: edges of its surface "
          "come very near each other; smooth or simplify the surface there");
    return factor * (*size)({p.x(), p.y(), p.z()});
  }
};

Tetrahedra taken_from(const Complex& complex) {
  Tetrahedra result;
  std::map<Triangulation::Vertex_handle, int> number;
  const auto number_of = [&](const Triangulation::Vertex_handle& vertex) {
    const auto [known, is_new] = number.try_emplace(vertex, int(result.vertices.size()));
    const auto& point = vertex->point();
    if (is_new) result.vertices.emplace_back(point.x(), point.y(), point.z());
    return known->second;
  };
  for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end(); ++cell)
    result.tetrahedra.push_back({number_of(cell->vertex(0)), number_of(cell->vertex(1)),
                                 number_of(cell->vertex(2)), number_of(cell->vertex(3))});
  for (auto facet = complex.facets_in_complex_begin(); facet != complex.facets_in_complex_end();
       ++facet) {
    Tetrahedra::Facet& taken = result.facets.emplace_back();
    for (int c = 0; c < 3; ++c)
      taken.corners[std::size_t(c)] = number_of(facet->first->vertex((facet->second + 1 + c) % 4));
    taken.part = complex.surface_patch_index(*facet) - 1;
  }
  return result;
}

}  // namespace

std::vector<PartBorder> borders_of(const PartedSurface& surface) {
  std::vector<PartBorder> borders;
  std::map<std::pair<int, int>, int> part_at;
  for (std::size_t t = 0; t < surface.parts.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const int a = surface.mesh.triangles[t][c], b = surface.mesh.triangles[t][(c + 1) % 3];
      const auto [known, is_new] = part_at.try_emplace(std::minmax(a, b), surface.parts[t]);
      if (!is_new && known->second != surface.parts[t])
        borders.push_back({{a, b}, {known->second, surface.parts[t]}});
    }
  return borders;
}

Tetrahedra tetrahedra_within(const PartedSurface& surface, const SizeField& size, double distance,
                             EdgeSizes edge_sizes) {
  namespace parameters = CGAL::parameters;
  CGAL::get_default_random() = CGAL::Random(0);  // the mesher draws from it
  Domain domain(surface_mesh(surface));
  const std::vector<Polyline> borders = Borders(surface).polylines();
  domain.add_features(borders.begin(), borders.end());
  long asked = 0;
  const Sizes edges{&size, 1.0, &asked}, radii{&size, radius_over_size, &asked};
  const Criteria criteria(parameters::edge_size = edges, parameters::facet_angle = min_facet_angle,
                          parameters::facet_size = radii, parameters::facet_distance = distance,
                          parameters::cell_radius_edge_ratio = radius_over_edge,
                          parameters::cell_size = radii);
  // Without a limit in time, on which the result would hang.
  const Complex complex = CGAL::make_mesh_3<Complex>(
      domain, criteria, parameters::exude(parameters::sliver_bound = sliver_angle),
      parameters::no_perturb(),
      parameters::mesh_3_options(parameters::nonlinear_growth_of_balls =
                                     edge_sizes == EdgeSizes::by_field));
  if (complex.number_of_cells_in_complex() == 0)
    throw NotConverged("the finger could not be filled with tetrahedra");
  return taken_from(complex);
}

}  // namespace fingertip::meshes::inline volume_mesh
