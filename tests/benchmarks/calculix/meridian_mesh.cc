#include "meridian_mesh.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

namespace fingertip::benchmarks {
namespace {

constexpr int quadrilateral_type = 3;  ///< gmsh's number of the four-node quadrilateral
constexpr std::size_t corners = 4;

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
std::map<std::size_t, MeridianPoint> read_nodes(std::istream& in) {
  std::map<std::size_t, MeridianPoint> nodes;
  const auto blocks = next<std::size_t>(in);
  for (int i = 0; i < 3; ++i) next<std::size_t>(in);
  for (std::size_t block = 0; block < blocks; ++block) {
    for (int i = 0; i < 3; ++i) next<int>(in);
    std::vector<std::size_t> tags(next<std::size_t>(in));
    for (std::size_t& tag : tags) tag = next<std::size_t>(in);
    for (const std::size_t tag : tags) {
      const auto r = next<double>(in), z = next<double>(in);
      next<double>(in);  // the file's third coordinate, 0
      nodes[tag] = {r, z};
    }
  }
  return nodes;
}

/// Node tags of the quadrilaterals; elements of other types are skipped.
std::vector<std::array<std::size_t, corners>> read_quadrilaterals(std::istream& in) {
  std::vector<std::array<std::size_t, corners>> quadrilaterals;
  const auto blocks = next<std::size_t>(in);
  for (int i = 0; i < 3; ++i) next<std::size_t>(in);
  for (std::size_t block = 0; block < blocks; ++block) {
    for (int i = 0; i < 2; ++i) next<int>(in);
    const int type = next<int>(in);
    const auto count = next<std::size_t>(in);
    std::string rest;
    std::getline(in, rest);
    for (std::size_t element = 0; element < count; ++element) {
      if (type != quadrilateral_type) {
        std::getline(in, rest);
        continue;
      }
      next<std::size_t>(in);
      for (std::size_t& node : quadrilaterals.emplace_back()) node = next<std::size_t>(in);
    }
  }
  return quadrilaterals;
}

MeridianMesh read(std::istream& in) {
  seek(in, "$MeshFormat");
  if (next<std::string>(in) != "4.1" || next<int>(in) != 0)
    throw std::runtime_error("is not in the ASCII format MSH 4.1");
  seek(in, "$Nodes");
  const std::map<std::size_t, MeridianPoint> all = read_nodes(in);
  seek(in, "$Elements");
  MeridianMesh mesh;
  std::map<std::size_t, std::size_t> index;
  for (const auto& quadrilateral : read_quadrilaterals(in)) {
    auto& element = mesh.elements.emplace_back();
    for (std::size_t i = 0; i < corners; ++i) {
      const auto [entry, fresh] = index.try_emplace(quadrilateral[i], mesh.nodes.size());
      if (fresh) mesh.nodes.push_back(all.at(quadrilateral[i]));
      element[i] = entry->second;
    }
  }
  if (mesh.elements.empty()) throw std::runtime_error("holds no quadrilaterals");
  return mesh;
}

/// The middle of an edge on the shell through its ends; no edge of the mesh crosses the equator.
MeridianPoint shell_midpoint(const MeridianPoint& a, const MeridianPoint& b) {
  const MeridianPoint middle = (a + b) / 2.0;
  if (!(middle.y() > 0.0)) return middle;
  return (a.norm() + b.norm()) / 2.0 * (a.normalized() + b.normalized()).normalized();
}

}  // namespace

double distance_from_core(const MeridianPoint& point) {
  return meshes::Geometry::radial_distance({point.x(), 0.0, point.y()});
}

MeridianMesh read_meridian_mesh(const std::filesystem::path& file) {
  std::ifstream in(file);
  try {
    if (!in) throw std::runtime_error("cannot be opened");
    return read(in);
  } catch (const std::exception& error) {
    throw std::runtime_error("the mesh " + file.string() + " " + error.what());
  }
}

MeridianMesh with_midside_nodes(const MeridianMesh& linear) {
  MeridianMesh mesh = linear;
  mesh.quadratic = true;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> middles;
  for (auto& element : mesh.elements)
    for (std::size_t i = 0; i < corners; ++i) {
      const std::size_t a = element[i], b = element[(i + 1) % corners];
      const auto [entry, fresh] = middles.try_emplace(std::minmax(a, b), mesh.nodes.size());
      if (fresh) mesh.nodes.push_back(shell_midpoint(mesh.nodes[a], mesh.nodes[b]));
      element[corners + i] = entry->second;
    }
  return mesh;
}

MeridianMesh cylinder_mesh(double radius, double height, int across, int along, int grading) {
  // Borders of elements over [0, 1], those at 1 (and at 0, where `both`) halved again and again.
  const auto borders = [&](int count, bool both) {
    std::vector<double> places;
    for (int i = 0; i <= count; ++i) places.push_back(double(i) / count);
    for (int g = 0; g < grading; ++g) {
      places.insert(places.end() - 1, 0.5 * (places[places.size() - 2] + 1.0));
      if (both) places.insert(places.begin() + 1, 0.5 * places[1]);
    }
    return places;
  };
  const std::vector<double> r = borders(across, false), z = borders(along, true);
  MeridianMesh mesh;
  mesh.quadratic = true;
  // Every half step is a node but the middles of elements.
  const std::size_t columns = 2 * r.size() - 1, rows = 2 * z.size() - 1, none = columns * rows;
  const auto at = [](const std::vector<double>& places, std::size_t half) {
    return 0.5 * (places[half / 2] + places[(half + 1) / 2]);
  };
  std::vector<std::size_t> number(none, none);
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      if (i % 2 == 1 && j % 2 == 1) continue;
      number[j * columns + i] = mesh.nodes.size();
      mesh.nodes.emplace_back(radius * at(r, i), height * at(z, j));
    }
  for (std::size_t j = 0; j + 2 < rows; j += 2)
    for (std::size_t i = 0; i + 2 < columns; i += 2) {
      const auto node = [&](std::size_t di, std::size_t dj) {
        return number[(j + dj) * columns + i + di];
      };
      mesh.elements.push_back({node(0, 0), node(2, 0), node(2, 2), node(0, 2), node(1, 0),
                               node(2, 1), node(1, 2), node(0, 1)});
    }
  return mesh;
}

std::vector<ElementEdge> outer_edges(const MeridianMesh& mesh, const meshes::Geometry& geometry,
                                     double lowest) {
  const double inside = (1.0 - 1e-9) * geometry.tip_radius;
  const auto outside = [&](std::size_t node) {
    return mesh.nodes[node].y() > lowest && distance_from_core(mesh.nodes[node]) > inside;
  };
  std::vector<ElementEdge> edges;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    for (std::size_t i = 0; i < corners; ++i)
      if (outside(mesh.elements[e][i]) && outside(mesh.elements[e][(i + 1) % corners]))
        edges.push_back({e, i + 1});
  return edges;
}

}  // namespace fingertip::benchmarks
