#include "solid_mesh.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

namespace fingertip::benchmarks {
namespace {

using meshes::Vector3;

constexpr int hexahedron_type = 5;  ///< gmsh's number of the eight-node hexahedron

void seek(std::istream& in, const std::string& section) {
  for (std::string line; std::getline(in, line);)
    if (line == section) return;
  throw std::runtime_error("lacks the section " + section);
}

template <class T>
T next(std::istream& in) {
  T value{};
  if (!(in >> value)) throw std::runtime_error("ends early or holds something that is no number");
  return value;
}

/// Nodes come in blocks: first all tags of the block, then all coordinates.
std::map<std::size_t, Vector3> read_nodes(std::istream& in) {
  std::map<std::size_t, Vector3> nodes;
  const auto blocks = next<std::size_t>(in);
  for (int i = 0; i < 3; ++i) next<std::size_t>(in);
  for (std::size_t block = 0; block < blocks; ++block) {
    for (int i = 0; i < 3; ++i) next<int>(in);
    std::vector<std::size_t> tags(next<std::size_t>(in));
    for (std::size_t& tag : tags) tag = next<std::size_t>(in);
    for (const std::size_t tag : tags)
      for (int i = 0; i < 3; ++i) nodes[tag][i] = next<double>(in);
  }
  return nodes;
}

/// Node tags of the hexahedra; elements of other types are skipped.
std::vector<std::array<std::size_t, 8>> read_hexahedra(std::istream& in) {
  std::vector<std::array<std::size_t, 8>> hexahedra;
  const auto blocks = next<std::size_t>(in);
  for (int i = 0; i < 3; ++i) next<std::size_t>(in);
  for (std::size_t block = 0; block < blocks; ++block) {
    for (int i = 0; i < 2; ++i) next<int>(in);
    const int type = next<int>(in);
    const auto count = next<std::size_t>(in);
    std::string rest;
    std::getline(in, rest);
    for (std::size_t element = 0; element < count; ++element) {
      if (type != hexahedron_type) {
        std::getline(in, rest);
        continue;
      }
      next<std::size_t>(in);
      for (std::size_t& node : hexahedra.emplace_back()) node = next<std::size_t>(in);
    }
  }
  return hexahedra;
}

SolidMesh read(std::istream& in) {
  seek(in, "$MeshFormat");
  if (next<std::string>(in) != "4.1" || next<int>(in) != 0)
    throw std::runtime_error("is not in the ASCII format MSH 4.1");
  seek(in, "$Nodes");
  const std::map<std::size_t, Vector3> all = read_nodes(in);
  seek(in, "$Elements");
  SolidMesh mesh;
  std::map<std::size_t, std::size_t> index;
  for (const auto& hexahedron : read_hexahedra(in)) {
    auto& element = mesh.elements.emplace_back();
    for (std::size_t i = 0; i < 8; ++i) {
      const auto [entry, fresh] = index.try_emplace(hexahedron[i], mesh.nodes.size());
      if (fresh) mesh.nodes.push_back(all.at(hexahedron[i]));
      element[i] = entry->second;
    }
  }
  if (mesh.elements.empty()) throw std::runtime_error("holds no hexahedra");
  return mesh;
}

/// The middle of an edge on the shell through its ends; no edge of the mesh crosses the equator.
Vector3 shell_midpoint(const Vector3& a, const Vector3& b) {
  const bool sphere = a.z() + b.z() > 0.0;
  const auto from_core = [sphere](Vector3 w) {
    if (!sphere) w.z() = 0.0;
    return w;
  };
  const Vector3 da = from_core(a), db = from_core(b);
  const double radius = (da.norm() + db.norm()) / 2.0;
  Vector3 middle = radius * (da.normalized() + db.normalized()).normalized();
  if (!sphere) middle.z() = (a.z() + b.z()) / 2.0;
  return middle;
}

}  // namespace

SolidMesh read_solid_mesh(const std::filesystem::path& file) {
  std::ifstream in(file);
  try {
    if (!in) throw std::runtime_error("cannot be opened");
    return read(in);
  } catch (const std::exception& error) {
    throw std::runtime_error("the mesh " + file.string() + " " + error.what());
  }
}

SolidMesh with_midside_nodes(const SolidMesh& linear) {
  // Corners of the edges in the order of their middle nodes.
  static constexpr std::array<std::pair<int, int>, 12> edges{{{0, 1},
                                                              {1, 2},
                                                              {2, 3},
                                                              {3, 0},
                                                              {4, 5},
                                                              {5, 6},
                                                              {6, 7},
                                                              {7, 4},
                                                              {0, 4},
                                                              {1, 5},
                                                              {2, 6},
                                                              {3, 7}}};
  SolidMesh mesh = linear;
  mesh.quadratic = true;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> middles;
  for (auto& element : mesh.elements)
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const std::size_t a = element[std::size_t(edges[i].first)];
      const std::size_t b = element[std::size_t(edges[i].second)];
      const auto [entry, fresh] = middles.try_emplace(std::minmax(a, b), mesh.nodes.size());
      if (fresh) mesh.nodes.push_back(shell_midpoint(mesh.nodes[a], mesh.nodes[b]));
      element[8 + i] = entry->second;
    }
  return mesh;
}

std::vector<ElementFace> outer_faces(const SolidMesh& mesh, const meshes::Geometry& geometry,
                                     double lowest) {
  static constexpr std::array<std::array<std::size_t, 4>, 6> corners{
      {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}}};
  const double tolerance = 1e-9 * geometry.tip_radius;
  std::vector<ElementFace> faces;
  for (std::size_t element = 0; element < mesh.elements.size(); ++element)
    for (int face = 0; face < 6; ++face) {
      const bool outside = std::ranges::all_of(corners[std::size_t(face)], [&](std::size_t corner) {
        const Vector3& w = mesh.nodes[mesh.elements[element][corner]];
        return w.z() > lowest &&
               std::abs(meshes::Geometry::radial_distance(w) - geometry.tip_radius) < tolerance;
      });
      if (outside) faces.push_back({element, face + 1});
    }
  return faces;
}

}  // namespace fingertip::benchmarks
