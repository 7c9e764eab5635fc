#include "meshes/volume_mesh/mesh_builders.h"

#include <gmsh.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "meshes/shape/geometry.h"
#include "meshes/volume_mesh/boundary_parts.h"

namespace fingertip::meshes::inline volume_mesh {
namespace {

/// Edges of tetrahedra in units of the thinnest rubber, and of the radius, over
/// TipMeshOptions::radial_elements: the whole dome starts with some 50 000 unknowns.
constexpr double size_over_wall = 4.0, size_over_radius = 2.4;
/// Edges at a narrow part of the surface, over its width.
constexpr double size_over_width = 1.5;
/// How fast edges may grow away from the place that touches first.
constexpr double growth = 0.5;
/// Distance of the tetrahedra's surface from the finger's, over the usual size.
constexpr double surface_distance = 0.1;
/// Where a corner's Jacobian is less, of a cube 1, sizes shrink by `smaller`.
constexpr double min_jacobian = 0.05, smaller = 0.7;
constexpr int max_attempts = 24;
/// Sizes over the usual with which filling begins. How often tetrahedra must shrink is a matter of
/// chance, so of the first `tried` the mesh of fewest hexahedra is taken, or one of so many that
/// chance is small; the others are for bodies that none of those fills.
constexpr std::array beginnings{1.0, 1.1, 1.05, 0.95, 0.85, 0.72};
constexpr std::size_t tried = 4, many = 5000;
/// Facets of a tetrahedron that turn by less than 60 degrees go on from one to the other.
constexpr double flat_cosine = 0.5;

/// Nodes and elements by numbers from 0.
struct HexahedralMesh {
  std::vector<Vector3> nodes;
  std::vector<std::array<int, 8>> hexahedra;  ///< bottom and top around, as gmsh has them
  std::map<PhysicalTag, std::vector<std::array<int, 4>>> quadrilaterals;
};

/// Sorted corners, of a tetrahedron's corner, edge, face or body.
using Simplex = std::vector<int>;

template <typename Corners>
Corners sorted(Corners corners) {
  std::ranges::sort(corners);
  return corners;
}

/// Two facets that go on from one to the other leave a hexahedron at their common edge hardly any
/// angle: tetrahedra with such facets are divided at their middle.
Tetrahedra without_flat_corners(Tetrahedra mesh) {
  using Corners = std::array<int, 3>;
  std::set<Corners> boundary;
  for (const Tetrahedra::Facet& facet : mesh.facets) boundary.insert(sorted(facet.corners));
  std::vector<std::array<int, 4>> all;
  for (const auto& tetrahedron : mesh.tetrahedra) {
    const auto at = [&](std::size_t c) { return mesh.vertices[std::size_t(tetrahedron[c % 4])]; };
    std::vector<Vector3> normals;  // out of the body
    for (std::size_t i = 0; i < 4; ++i) {
      if (!boundary.contains(sorted(Corners{tetrahedron[(i + 1) % 4], tetrahedron[(i + 2) % 4],
                                            tetrahedron[(i + 3) % 4]})))
        continue;
      const Vector3 normal = (at(i + 2) - at(i + 1)).cross(at(i + 3) - at(i + 1)).normalized();
      normals.push_back(normal.dot(at(i) - at(i + 1)) < 0.0 ? normal : Vector3(-normal));
    }
    bool flat = false;
    for (std::size_t i = 0; i < normals.size(); ++i)
      for (std::size_t k = 0; k < i; ++k) flat |= normals[i].dot(normals[k]) > flat_cosine;
    if (!flat) {
      all.push_back(tetrahedron);
      continue;
    }
    const int middle = int(mesh.vertices.size());
    mesh.vertices.push_back((at(0) + at(1) + at(2) + at(3)) / 4.0);
    for (std::size_t i = 0; i < 4; ++i) {
      all.push_back(tetrahedron);
      all.back()[i] = middle;
    }
  }
  mesh.tetrahedra = std::move(all);
  return mesh;
}

/// Smallest Jacobian at a corner of a hexahedron over the lengths of its edges.
double worst_corner(const HexahedralMesh& mesh, const std::array<int, 8>& hexahedron) {
  double least = 1.0;
  for (std::size_t i = 0; i < 8; ++i) {
    const auto at = [&](std::size_t k) { return mesh.nodes[std::size_t(hexahedron[k])]; };
    const std::size_t base = i / 4 * 4, k = i % 4;
    const Vector3 next = (at(base + (k + 1) % 4) - at(i)).normalized(),
                  previous = (at(base + (k + 3) % 4) - at(i)).normalized(),
                  across = (at((i + 4) % 8) - at(i)).normalized();
    least = std::min(least, (base == 0 ? 1.0 : -1.0) * next.cross(previous).dot(across));
  }
  return least;
}

/// Divides tetrahedra at the middles of edges, faces and bodies.
class Splitting {
 public:
  /// The middles of `flat` are not brought to the surface.
  Splitting(const Tetrahedra& tetrahedra, const BoundaryParts& parts, const std::set<Simplex>& flat)
      : tetrahedra_(tetrahedra), parts_(parts), flat_(flat) {
    for (const Tetrahedra::Facet& facet : tetrahedra.facets) {
      const auto& [a, b, c] = facet.corners;
      for (const Simplex& corners : {Simplex{a}, {b}, {c}, {a, b}, {b, c}, {c, a}, {a, b, c}})
        meeting_[sorted(corners)].insert(facet.part);
    }
    for (const auto& [a, b, c, d] : tetrahedra.tetrahedra) {
      // Every corner with the other three in the same sense.
      add_hexahedron(a, b, c, d);
      add_hexahedron(b, a, d, c);
      add_hexahedron(c, d, a, b);
      add_hexahedron(d, c, b, a);
    }
    for (const Tetrahedra::Facet& facet : tetrahedra.facets)
      for (std::size_t i = 0; i < 3; ++i) {
        const int a = facet.corners[i], b = facet.corners[(i + 1) % 3],
                  c = facet.corners[(i + 2) % 3];
        mesh_.quadrilaterals[parts.tag(facet.part)].push_back(
            {node({a}), node({a, b}), node({a, b, c}), node({a, c})});
      }
  }

  const HexahedralMesh& mesh() const { return mesh_; }

  /// What bad hexahedra have on parts with hidden edges, and is not flat yet.
  std::set<Simplex> to_flatten() const {
    std::set<int> bad;
    for (const auto& hexahedron : mesh_.hexahedra)
      if (worst_corner(mesh_, hexahedron) < min_jacobian)
        bad.insert(hexahedron.begin(), hexahedron.end());
    std::set<Simplex> found;
    for (const auto& [corners, number] : numbers_)
      if (corners.size() > 1 && bad.contains(number) && within_hidden_edges(corners) &&
          !flat_.contains(corners))
        found.insert(corners);
    return found;
  }

 private:
  bool within_hidden_edges(const Simplex& corners) const {
    const auto parts = meeting_.find(corners);
    return parts != meeting_.end() && parts->second.size() == 1 &&
           parts_.hides_edges(*parts->second.begin());
  }

  void add_hexahedron(int a, int b, int c, int d) {
    mesh_.hexahedra.push_back({node({a}), node({a, b}), node({a, b, c}), node({a, c}), node({a, d}),
                               node({a, b, d}), node({a, b, c, d}), node({a, c, d})});
  }

  /// In the middle of corners, and on the surface where they are.
  int node(Simplex corners) {
    corners = sorted(std::move(corners));
    const auto [known, is_new] = numbers_.try_emplace(corners, int(mesh_.nodes.size()));
    if (!is_new) return known->second;
    const int number = known->second;
    mesh_.nodes.emplace_back();
    Vector3 middle = middle_of(corners);
    if (const auto parts = meeting_.find(corners);
        parts != meeting_.end() && !flat_.contains(corners))
      middle = parts_.on({parts->second.begin(), parts->second.end()}, middle);
    mesh_.nodes[std::size_t(number)] = middle;
    return number;
  }

  /// Of a corner, an edge, a face or a body whose edges are parabolas through their nodes.
  Vector3 middle_of(const Simplex& corners) {
    if (corners.size() == 1) return tetrahedra_.vertices[std::size_t(corners[0])];
    // Weights of the corners' and the edges' shape functions there.
    const double own = corners.size() == 2 ? 0.5 : corners.size() == 3 ? -1.0 / 9.0 : -1.0 / 8.0;
    const double edge = corners.size() == 2 ? 0.0 : corners.size() == 3 ? 4.0 / 9.0 : 1.0 / 4.0;
    Vector3 sum = Vector3::Zero();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      sum += own * mesh_.nodes[std::size_t(node({corners[i]}))];
      for (std::size_t k = 0; k < i && edge > 0.0; ++k)
        sum += edge * mesh_.nodes[std::size_t(node({corners[i], corners[k]}))];
    }
    return sum;
  }

  const Tetrahedra& tetrahedra_;
  const BoundaryParts& parts_;
  const std::set<Simplex>& flat_;
  std::map<Simplex, std::set<int>> meeting_;  ///< parts at corners, edges and facets
  std::map<Simplex, int> numbers_;
  HexahedralMesh mesh_;
};

/// With as few sides flat as elements allow, where edges are hidden.
HexahedralMesh divided(const Tetrahedra& tetrahedra, const BoundaryParts& parts) {
  std::set<Simplex> flat;
  while (true) {
    const Splitting splitting(tetrahedra, parts, flat);
    std::set<Simplex> more = splitting.to_flatten();
    if (more.empty()) return splitting.mesh();
    flat.merge(more);
  }
}

/// Lengths of edges, small around some places.
class Sizes {
 public:
  explicit Sizes(double usual) : usual_(usual) {}

  void add(const Vector3& place, double size) { small_.push_back({place, size}); }
  double at(const Vector3& w) const {
    double size = usual_;
    for (const auto& [place, own] : small_)
      size = std::min(size, own + growth * (w - place).norm());
    return size;
  }

  /// Small ones along the borders of parts that are narrower than the usual size.
  void add_narrow(const PartedSurface& surface) {
    struct Part {
      double area = 0.0, length = 0.0;
      std::vector<std::array<Vector3, 2>> border;
    };
    std::map<int, Part> all;
    for (std::size_t t = 0; t < surface.parts.size(); ++t)
      all[surface.parts[t]].area += surface.mesh.area_vector(t).norm();
    for (const auto& [ends, parts] : borders_of(surface)) {
      const Vector3 &from = surface.mesh.vertices[std::size_t(ends[0])],
                    &to = surface.mesh.vertices[std::size_t(ends[1])];
      for (const int number : parts) {
        all[number].length += (to - from).norm();
        all[number].border.push_back({from, to});
      }
    }
    for (const auto& [number, part] : all) {
      const double size = size_over_width * 2.0 * part.area / part.length;  // of a strip
      if (!(size < usual_)) continue;
      for (const auto& [from, to] : part.border) {
        const int pieces = 1 + int((to - from).norm() / size);
        for (int i = 0; i <= pieces; ++i) add(from + double(i) / pieces * (to - from), size);
      }
    }
  }

  /// Smaller ones at these places.
  void shrink(const std::vector<Vector3>& places) {
    std::vector<std::pair<Vector3, double>> found;
    found.reserve(places.size());
    for (const Vector3& place : places) found.emplace_back(place, smaller * at(place));
    for (const auto& [place, size] : found)
      if (size < at(place)) add(place, size);
  }

 private:
  double usual_;
  std::vector<std::pair<Vector3, double>> small_;
};

/// Middles of bad hexahedra.
std::vector<Vector3> bad_places(const HexahedralMesh& mesh) {
  std::vector<Vector3> places;
  for (const auto& hexahedron : mesh.hexahedra) {
    if (worst_corner(mesh, hexahedron) >= min_jacobian) continue;
    places.push_back(Vector3::Zero());
    for (const int node : hexahedron) places.back() += mesh.nodes[std::size_t(node)] / 8.0;
  }
  return places;
}

void hand_to_gmsh(const HexahedralMesh& mesh) {
  std::vector<std::size_t> numbers;
  std::vector<double> places;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    numbers.push_back(n + 1);
    places.insert(places.end(), mesh.nodes[n].data(), mesh.nodes[n].data() + 3);
  }
  constexpr int quadrangle = 3, hexahedron = 5;  // gmsh's types
  const auto corners_of = [](const auto& elements) {
    std::vector<std::size_t> corners;
    for (const auto& element : elements)
      for (const int corner : element) corners.push_back(std::size_t(corner) + 1);
    return corners;
  };
  const int body = gmsh::model::addDiscreteEntity(3);
  gmsh::model::mesh::addNodes(3, body, numbers, places);
  gmsh::model::mesh::addElementsByType(body, hexahedron, {}, corners_of(mesh.hexahedra));
  name_group(3, {body}, PhysicalTag::tip, "tip");
  const std::map<PhysicalTag, const char*> names{{PhysicalTag::outer, "outer"},
                                                 {PhysicalTag::bond, "bond"},
                                                 {PhysicalTag::end, "end"},
                                                 {PhysicalTag::symmetry_x, "symmetry_x"},
                                                 {PhysicalTag::symmetry_y, "symmetry_y"}};
  for (const auto& [tag, quadrilaterals] : mesh.quadrilaterals) {
    const int surface = gmsh::model::addDiscreteEntity(2);
    gmsh::model::mesh::addElementsByType(surface, quadrangle, {}, corners_of(quadrilaterals));
    name_group(2, {surface}, tag, names.at(tag));
  }
}

}  // namespace

void build_split_mesh(const Geometry& geometry, const TipMeshOptions& options) {
  const std::unique_ptr<const BoundaryParts> parts = boundary_parts(geometry);
  const std::shared_ptr<const Shape> shape = shape_of(geometry);
  const PartedSurface surface = parts->surface(options.sector);
  const double wall = std::min(geometry.thickness(), shape->wall()),
               radius = std::min(shape->pole_radius(), shape->largest_radius());
  const double usual =
      std::min(size_over_wall * wall, size_over_radius * radius) / options.radial_elements;
  Vector3 touch = options.touch.value_or(Vector3(0.0, 0.0, shape->pole()));
  if (options.sector != Sector::full) touch.y() = std::abs(touch.y());
  if (options.sector == Sector::quarter) touch.x() = std::abs(touch.x());
  Vector3 last = touch;
  std::optional<HexahedralMesh> best;
  const auto better = [&](Sizes sizes) -> std::optional<HexahedralMesh> {
    for (int attempt = 0; attempt < max_attempts; ++attempt) {
      const Tetrahedra tetrahedra = without_flat_corners(tetrahedra_within(
          surface, [&](const Vector3& w) { return sizes.at(w); }, surface_distance * usual,
          EdgeSizes::by_field));
      HexahedralMesh mesh = divided(tetrahedra, *parts);
      // It only grows from here.
      if (best && mesh.hexahedra.size() >= best->hexahedra.size()) return {};
      const std::vector<Vector3> bad = bad_places(mesh);
      if (bad.empty()) return mesh;
      last = bad.front();
      sizes.shrink(bad);
    }
    return {};
  };
  for (std::size_t i = 0; i < beginnings.size(); ++i) {
    if (best && (i >= tried || best->hexahedra.size() > many)) break;
    Sizes sizes(beginnings[i] * usual);
    sizes.add(touch, beginnings[i] * usual / options.cap_grading);
    sizes.add_narrow(surface);
    try {
      if (auto mesh = better(std::move(sizes))) best = std::move(mesh);
    } catch (const NotConverged&) {  // more tetrahedra than is sensible
      if (!best) throw;
    }
  }
  if (best) return hand_to_gmsh(*best);
  throw NotConverged(
      "the finger could not be filled with hexahedra: near " + place_of(last) +
      " its surface turns too much over lengths as short as its elements; round its edges there, "
      "leave out steps and chamfers of less than 3 % of its largest radius, or choose a larger "
      "reference.refinement");
}

}  // namespace fingertip::meshes::inline volume_mesh
