#include "meshes/shape/triangle_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <unordered_map>
#include <utility>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::meshes::inline shape {
namespace {

/// Smallest and largest extent of a finger [m].
constexpr double smallest_solid = 0.5e-3, largest_solid = 0.5;
/// Vertices closer than this share of the extent are one: a file has seven digits.
constexpr double one_vertex = 1e-6;

[[noreturn]] void refuse_surface(const std::string& value, const std::string& rule,
                                 const std::string& remedy) {
  throw InvalidInput({"geometry.file", value, rule, remedy});
}

constexpr const char* mend = "mend the mesh in the program that made it";

double extent_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vector3& vertex : mesh.vertices) {
    if (!vertex.allFinite())
      refuse_surface("", "coordinates must be finite numbers", "write the file anew");
    box.extend(vertex);
  }
  const double extent = box.sizes().maxCoeff();
  if (!(extent >= smallest_solid && extent <= largest_solid)) {
    char text[64];
    std::snprintf(text, sizeof text, "%.3g m across", extent);
    throw InvalidInput({"geometry.unit", text, "a finger measures 0.5 mm to 0.5 m",
                        "give the unit of the numbers in geometry.file, e.g. geometry.unit = "
                        "\"mm\""});
  }
  return extent;
}

/// Numbers of the vertices once those within `distance` of an earlier one are that one.
class VertexMerger {
 public:
  explicit VertexMerger(double distance) : distance_(distance) {}

  int number_of(const Vector3& w) {
    const auto cell = cell_of(w);
    for (std::int64_t i = -1; i <= 1; ++i)
      for (std::int64_t j = -1; j <= 1; ++j)
        for (std::int64_t k = -1; k <= 1; ++k) {
          const auto found = cells_.find(key({cell[0] + i, cell[1] + j, cell[2] + k}));
          if (found == cells_.end()) continue;
          for (const int candidate : found->second)
            if ((vertices_[std::size_t(candidate)] - w).norm() <= distance_) return candidate;
        }
    cells_[key(cell)].push_back(int(vertices_.size()));
    vertices_.push_back(w);
    return int(vertices_.size()) - 1;
  }

  std::vector<Vector3> take() { return std::move(vertices_); }

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell_of(const Vector3& w) const {
    const auto cell = [this](double x) { return std::int64_t(std::floor(x / distance_)); };
    return {cell(w.x()), cell(w.y()), cell(w.z())};
  }
  /// Cells that share a key are told apart by the distances of what they hold.
  static std::uint64_t key(const Cell& cell) {
    std::uint64_t value = 0;
    for (const std::int64_t c : cell) value = (value ^ std::uint64_t(c)) * 0x9e3779b97f4a7c15u;
    return value;
  }

  double distance_;
  std::vector<Vector3> vertices_;
  std::unordered_map<std::uint64_t, std::vector<int>> cells_;
};

TriangleMesh merged(const TriangleMesh& mesh, double distance) {
  VertexMerger merger(distance);
  std::vector<int> number;
  for (const Vector3& vertex : mesh.vertices) number.push_back(merger.number_of(vertex));
  TriangleMesh result;
  result.face_names = mesh.face_names;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<int, 3> corners{};
    for (std::size_t c = 0; c < 3; ++c) corners[c] = number[std::size_t(mesh.triangles[t][c])];
    const auto [a, b, c] = corners;
    if (a == b || b == c || c == a) continue;
    result.triangles.push_back(corners);
    if (!mesh.faces.empty()) result.faces.push_back(mesh.faces[t]);
  }
  result.vertices = merger.take();
  return result;
}

/// Edges with a direction, and the triangle on whose rim they run.
class Edges {
 public:
  explicit Edges(const TriangleMesh& mesh) : mesh_(&mesh) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c) {
        const int a = mesh.triangles[t][c], b = mesh.triangles[t][(c + 1) % 3];
        if (!triangle_.emplace(key(a, b), t).second) twice(a, b);
      }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c) {
        const int a = mesh.triangles[t][c], b = mesh.triangles[t][(c + 1) % 3];
        if (!triangle_.contains(key(b, a)))
          refuse_surface("open edge at " + place(a, b), "the surface must be closed, without holes",
                         "fill the hole: " + std::string(mend));
      }
  }

  /// The triangle across the edge of another one.
  std::size_t across(int a, int b) const { return triangle_.at(key(b, a)); }

 private:
  static std::uint64_t key(int a, int b) {
    return std::uint64_t(std::uint32_t(a)) << 32 | std::uint32_t(b);
  }
  std::string place(int a, int b) const {
    return place_of(0.5 * (mesh_->vertices[std::size_t(a)] + mesh_->vertices[std::size_t(b)]));
  }
  [[noreturn]] void twice(int a, int b) const {
    int around = 0;
    for (const auto& triangle : mesh_->triangles)
      around += int(std::ranges::count(triangle, a) + std::ranges::count(triangle, b) == 2);
    if (around > 2)
      refuse_surface("edge at " + place(a, b) + ", " + std::to_string(around) + " facets",
                     "two facets meet at every edge of the surface",
                     "remove inner and double facets, or " + std::string(mend));
    refuse_surface("edge at " + place(a, b),
                   "neighbouring facets must face the same way, out of the rubber",
                   "make the normals consistent in the program that made the mesh");
  }

  const TriangleMesh* mesh_;
  std::unordered_map<std::uint64_t, std::size_t> triangle_;
};

/// Around every vertex, facets form one ring.
void check_vertices(const TriangleMesh& mesh, const Edges& edges) {
  std::vector<int> count(mesh.vertices.size(), 0);
  std::vector<std::pair<std::size_t, std::size_t>> first(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      ++count[std::size_t(mesh.triangles[t][c])];
      first[std::size_t(mesh.triangles[t][c])] = {t, c};
    }
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (count[v] == 0) continue;
    auto [t, c] = first[v];
    int ring = 0;
    do {
      t = edges.across(int(v), mesh.triangles[t][(c + 1) % 3]);
      c = std::size_t(std::ranges::find(mesh.triangles[t], int(v)) - mesh.triangles[t].begin());
      ++ring;
    } while (t != first[v].first && ring <= count[v]);
    if (ring != count[v])
      refuse_surface("vertex at " + place_of(mesh.vertices[v]),
                     "the surface must not touch itself at a point",
                     "join or part what meets there");
  }
}

/// The connected part of every triangle, numbered from 0.
std::vector<std::size_t> parts_of(const TriangleMesh& mesh, const Edges& edges) {
  constexpr std::size_t none = std::size_t(-1);
  std::vector<std::size_t> part(mesh.triangles.size(), none), next;
  std::size_t parts = 0;
  for (std::size_t seed = 0; seed < part.size(); ++seed) {
    if (part[seed] != none) continue;
    next.assign(1, seed);
    part[seed] = parts;
    while (!next.empty()) {
      const std::size_t t = next.back();
      next.pop_back();
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t other =
            edges.across(mesh.triangles[t][c], mesh.triangles[t][(c + 1) % 3]);
        if (part[other] == none) next.push_back(other), part[other] = parts;
      }
    }
    ++parts;
  }
  return part;
}

/// Share of the full solid angle under which a part of the surface is seen from w: 1 within it.
/// Van Oosterom & Strackee, IEEE Trans. Biomed. Eng. 30 (1983) 125.
double winding(const TriangleMesh& mesh, const std::vector<std::size_t>& part, std::size_t own,
               const Vector3& w) {
  double angle = 0.0;
  for (std::size_t t = 0; t < part.size(); ++t) {
    if (part[t] != own) continue;
    const Vector3 a = mesh.corner(t, 0) - w, b = mesh.corner(t, 1) - w, c = mesh.corner(t, 2) - w;
    const double x = a.norm(), y = b.norm(), z = c.norm();
    angle +=
        2.0 * std::atan2(a.dot(b.cross(c)), x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y);
  }
  return angle / (4.0 * std::numbers::pi);
}

/// One body that faces outward; parts within it that face inward are its cavities.
void check_parts(const TriangleMesh& mesh, const Edges& edges) {
  const std::vector<std::size_t> part = parts_of(mesh, edges);
  std::vector<double> volume(*std::ranges::max_element(part) + 1, 0.0);
  std::vector<std::size_t> first(volume.size(), part.size());
  const Vector3 origin = mesh.vertices.front();
  for (std::size_t t = 0; t < part.size(); ++t) {
    volume[part[t]] += (mesh.centroid(t) - origin).dot(mesh.area_vector(t)) / 3.0;
    first[part[t]] = std::min(first[part[t]], t);
  }
  const auto is_body = [](double v) { return v > 0.0; };
  const auto body = std::ranges::find_if(volume, is_body);
  if (body == volume.end())
    refuse_surface("all facets face inward", "facets must face out of the rubber",
                   "turn the normals (invert the faces) in the program that made the mesh");
  const auto second = std::find_if(body + 1, volume.end(), is_body);
  if (second != volume.end())
    refuse_surface(
        "bodies near " + place_of(mesh.centroid(first[std::size_t(body - volume.begin())])) +
            " and " + place_of(mesh.centroid(first[std::size_t(second - volume.begin())])),
        "the finger is one body", "unite the bodies, or leave one of them out");
  const std::size_t own = std::size_t(body - volume.begin());
  for (std::size_t p = 0; p < volume.size(); ++p)
    if (p != own && winding(mesh, part, own, mesh.corner(first[p], 0)) < 0.5)
      refuse_surface("part near " + place_of(mesh.centroid(first[p])),
                     "a part outside of the body must not face inward",
                     "turn its normals and unite it with the body, or leave it out");
}

}  // namespace

Vector3 TriangleMesh::area_vector(std::size_t triangle) const {
  const Vector3& a = corner(triangle, 0);
  return 0.5 * (corner(triangle, 1) - a).cross(corner(triangle, 2) - a);
}

int TriangleMesh::face_number(const std::string& name) {
  if (name.empty()) return -1;
  const auto found = std::ranges::find(face_names, name);
  if (found != face_names.end()) return int(found - face_names.begin());
  face_names.push_back(name);
  return int(face_names.size()) - 1;
}

std::string or_faces(const std::vector<std::string>& names) {
  constexpr std::size_t most = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i)
    text += (i == 0 ? ", or name faces: " : ", ") + names[i];
  return names.size() <= most ? text
                              : text + " and " + std::to_string(names.size() - most) + " more";
}

std::string place_of(const Vector3& w) {
  char text[96];
  std::snprintf(text, sizeof text, "(x, y, z) = (%.4g, %.4g, %.4g) mm", 1e3 * w.x(), 1e3 * w.y(),
                1e3 * w.z());
  return text;
}

TriangleMesh closed_surface(const TriangleMesh& mesh) {
  if (mesh.triangles.size() < 4)
    refuse_surface(std::to_string(mesh.triangles.size()) + " facets",
                   "a closed surface has at least four", "give the whole surface of the finger");
  TriangleMesh result = merged(mesh, one_vertex * extent_of(mesh));
  if (result.triangles.size() < 4)
    refuse_surface("facets without area", "a closed surface has at least four facets",
                   "give the whole surface of the finger");
  const Edges edges(result);
  check_vertices(result, edges);
  check_parts(result, edges);
  return result;
}

std::map<std::pair<int, int>, int> cut_along(TriangleMesh& mesh, int axis, double limit,
                                             double grain) {
  const auto height = [&](int vertex) { return mesh.vertices[std::size_t(vertex)][axis] - limit; };
  const auto side = [&](int vertex) {
    const double own = height(vertex);
    return std::abs(own) <= grain ? 0 : own > 0.0 ? 1 : -1;
  };
  std::map<std::pair<int, int>, int> cuts;
  const auto meeting = [&](int a, int b) {
    const auto [place, is_new] = cuts.try_emplace(std::minmax(a, b), int(mesh.vertices.size()));
    if (is_new) {  // once for both triangles of an edge
      const auto [low, high] = place->first;
      const double from = height(low), to = height(high);
      const Vector3 &start = mesh.vertices[std::size_t(low)],
                    &end = mesh.vertices[std::size_t(high)];
      Vector3 w = start + from / (from - to) * (end - start);
      w[axis] = limit;
      mesh.vertices.push_back(w);
    }
    return place->second;
  };
  std::vector<std::array<int, 3>> pieces;
  std::vector<int> faces;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& triangle = mesh.triangles[t];
    std::array<std::vector<int>, 2> sides;  // below and above
    for (std::size_t c = 0; c < 3; ++c) {
      const int a = triangle[c], b = triangle[(c + 1) % 3];
      const int from = side(a), to = side(b);
      if (from <= 0) sides[0].push_back(a);
      if (from >= 0) sides[1].push_back(a);
      if (from * to >= 0) continue;
      const int cut = meeting(a, b);
      for (auto& polygon : sides) polygon.push_back(cut);
    }
    // A triangle that only touches the plane, or lies in it, is not cut.
    if (sides[0].size() < 3 || sides[1].size() < 3 || sides[0] == sides[1])
      pieces.push_back(triangle);
    else
      for (const auto& polygon : sides)
        for (std::size_t c = 2; c < polygon.size(); ++c)
          pieces.push_back({polygon[0], polygon[c - 1], polygon[c]});
    if (!mesh.faces.empty()) faces.resize(pieces.size(), mesh.faces[t]);
  }
  mesh.triangles = std::move(pieces);
  mesh.faces = std::move(faces);
  return cuts;
}

}  // namespace fingertip::meshes::inline shape
