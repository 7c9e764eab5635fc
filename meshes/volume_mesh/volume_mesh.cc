#include "meshes/volume_mesh/volume_mesh.h"

#include <gmsh.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "meshes/volume_mesh/mesh_builders.h"

namespace fingertip::meshes::inline volume_mesh {
namespace {

/// gmsh keeps one global state; this opens and closes it, and keeps it quiet.
class GmshSession {
 public:
  GmshSession() {
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::option::setNumber("General.NumThreads", 1);
    gmsh::model::add("tip");
  }
  ~GmshSession() { gmsh::finalize(); }
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;
};

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

MeshQuality measure() {
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

MeshQuality mesh_tip(const Geometry& geometry, const TipMeshOptions& options,
                     const std::filesystem::path& file) {
  const GmshSession session;
  if (options.sector == Sector::meridian) {
    if (geometry.is_dome())
      build_dome_meridian(geometry, options);
    else
      build_meridian(geometry, options);
    gmsh::model::mesh::generate(2);
  } else if (!geometry.is_dome()) {
    build_split_mesh(geometry, options);
  } else {
    build_dome_mesh(geometry, options);
  }

  const MeshQuality quality = measure();
  if (!(quality.min_jacobian > 0.0))
    throw NotConverged("the mesh of the tip has an inverted element (smallest Jacobian " +
                       std::to_string(quality.min_jacobian) + " m^3); use a milder grading");
  gmsh::option::setNumber("Mesh.MshFileVersion", 4.1);
  gmsh::write(file.string());
  return quality;
}

[[noreturn]] void refuse_mesh(const std::filesystem::path& file, const std::string& rule) {
  throw InvalidInput({"mesh", file.string(), rule, "delete the file and run again"});
}

}  // namespace

MeshQuality inspect_tip_mesh(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) refuse_mesh(file, "the mesh file must exist");
  MeshQuality quality;
  try {
    const GmshSession session;
    gmsh::open(file.string());
    quality = measure();
  } catch (const std::string& message) {  // gmsh's way of failing
    refuse_mesh(file, "the mesh file must be complete: " + message);
  } catch (const std::exception&) {
    refuse_mesh(file, "the elements of the mesh must refer to its nodes");
  }
  if (quality.hexahedra == 0) refuse_mesh(file, "the mesh must have hexahedra or quadrilaterals");
  if (!(quality.min_jacobian > 0.0)) refuse_mesh(file, "no element of the mesh may be inverted");
  return quality;
}

MeshQuality write_tip_mesh(const Geometry& geometry, const TipMeshOptions& options,
                           const std::filesystem::path& file) {
  std::vector<Violation> broken = geometry.violations();
  append(broken, options.violations());
  if (!broken.empty()) throw InvalidInput(broken);
  try {
    return mesh_tip(geometry, options, file);
  } catch (const std::string& message) {  // gmsh's way of failing
    throw NotConverged("gmsh could not mesh the tip: " + message);
  }
}

}  // namespace fingertip::meshes::inline volume_mesh
