#include "meshes/mesh_quality.h"

#include <gmsh.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <map>
#include <numbers>
#include <vector>

namespace fingertip::meshes {
namespace {

/// Elements of one type with the places of their nodes.
struct Elements {
  std::map<std::size_t, Vector3> nodes;
  std::vector<std::vector<std::size_t>> corners;  ///< of each element
};

Elements read_elements(const char* type_name, std::size_t corners) {
  Elements mesh;
  std::vector<std::size_t> tags, element_tags, nodes;
  std::vector<double> coordinates, parameters;
  gmsh::model::mesh::getNodes(tags, coordinates, parameters);
  std::map<std::size_t, Vector3> all;
  for (std::size_t i = 0; i < tags.size(); ++i)
    all[tags[i]] = {coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]};
  const int type = gmsh::model::mesh::getElementType(type_name, 1);
  gmsh::model::mesh::getElementsByType(type, element_tags, nodes);
  mesh.corners.resize(element_tags.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    mesh.corners[i / corners].push_back(nodes[i]);
    mesh.nodes[nodes[i]] = all.at(nodes[i]);
  }
  return mesh;
}

struct CornerJacobian {
  double plain, scaled;  ///< the latter divided by the lengths of the edges that meet there
};

/// At the corners of a straight-sided hexahedron, where the extremes of what one can check cheaply
/// lie, or of a quadrilateral.
std::vector<CornerJacobian> corner_jacobians(const std::vector<Vector3>& w) {
  // gmsh numbers around a face; a hexahedron's bottom 0-3 and top 4-7, both in the same sense.
  std::vector<CornerJacobian> result;
  for (std::size_t i = 0; i < w.size(); ++i) {
    const std::size_t base = i / 4 * 4, k = i % 4;
    const Vector3 next = w[base + (k + 1) % 4] - w[i];
    const Vector3 previous = w[base + (k + 3) % 4] - w[i];
    const Vector3 across = w.size() == 4 ? Vector3(Vector3::UnitZ()) : w[(i + 4) % 8] - w[i];
    const double sign = base == 0 ? 1.0 : -1.0;
    const double jacobian = sign * next.cross(previous).dot(across);
    result.push_back({jacobian, jacobian / (next.norm() * previous.norm() * across.norm())});
  }
  return result;
}

/// ∫ det J over the unit element by the 2-point Gauss rule along each direction, exact for
/// multilinear maps; times 2 pi r for quadrilaterals.
double swept_volume(const char* type_name, bool meridian) {
  std::vector<double> points, weights, jacobians, determinants, coordinates;
  const int type = gmsh::model::mesh::getElementType(type_name, 1);
  gmsh::model::mesh::getIntegrationPoints(type, "Gauss2", points, weights);
  gmsh::model::mesh::getJacobians(type, points, jacobians, determinants, coordinates);
  double volume = 0.0;
  for (std::size_t i = 0; i < determinants.size(); ++i)
    volume += determinants[i] * weights[i % weights.size()] *
              (meridian ? 2.0 * std::numbers::pi * coordinates[3 * i] : 1.0);
  return volume;
}

}  // namespace

MeshQuality measure_mesh() {
  Elements mesh = read_elements("hexahedron", 8);
  const bool meridian = mesh.corners.empty();
  const char* type = meridian ? "quadrangle" : "hexahedron";
  if (meridian) mesh = read_elements(type, 4);
  MeshQuality quality;
  quality.hexahedra = mesh.corners.size();
  quality.nodes = mesh.nodes.size();
  quality.volume = swept_volume(type, meridian);
  quality.min_jacobian = quality.min_scaled_jacobian = std::numeric_limits<double>::infinity();
  for (const auto& element : mesh.corners) {
    std::vector<Vector3> corners;
    for (const std::size_t node : element) corners.push_back(mesh.nodes.at(node));
    for (const auto& [jacobian, scaled] : corner_jacobians(corners)) {
      quality.min_jacobian = std::min(quality.min_jacobian, jacobian);
      quality.min_scaled_jacobian = std::min(quality.min_scaled_jacobian, scaled);
    }
  }
  return quality;
}

}  // namespace fingertip::meshes
