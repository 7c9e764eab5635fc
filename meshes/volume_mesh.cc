#include "meshes/volume_mesh.h"

#include <gmsh.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <limits>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "meshes/meridian_mesh.h"
#include "meshes/split_mesh.h"

namespace fingertip::meshes {
namespace {

/// The diagonal corner of the cap lies this much further from the pole than the two on the
/// meridians: it opens the obtuse angle of that corner (measured in README).
constexpr double diagonal_stretch = 1.2;

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

enum Layer { inner = 0, outer_layer = 1 };
enum Ring { pole = 0, cap = 1, equator = 2, end_ring = 3 };

/// A corner of the block structure.
struct Corner {
  int layer = inner;
  int ring = pole;
  int azimuth = 0;  ///< in steps of 45 degrees; 0 at the pole
  auto operator<=>(const Corner&) const = default;
};

using Quad = std::array<Corner, 4>;  ///< around the face

/// The blocks as gmsh entities. Every entity is made once, on first use, and found again by its
/// corners, so that neighbouring blocks share it and no coincident nodes arise.
class BlockStructure {
 public:
  BlockStructure(const Geometry& geometry, const TipMeshOptions& options)
      : geometry_(geometry), options_(options) {
    centre_ = gmsh::model::geo::addPoint(0, 0, 0);
    end_centre_ = gmsh::model::geo::addPoint(0, 0, -geometry.sleeve_length);
  }

  /// The block between an inner and an outer face; `face` names the corners of one of them.
  void add_block(const Quad& face) {
    std::array<Quad, 6> quads;
    for (const int layer : {inner, outer_layer}) {
      quads[std::size_t(layer)] = face;
      for (Corner& corner : quads[std::size_t(layer)]) corner.layer = layer;
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t next = (i + 1) % 4;
      quads[2 + i] = {quads[0][i], quads[0][next], quads[1][next], quads[1][i]};
    }
    std::vector<int> surfaces, corners;
    for (const Quad& quad : quads) surfaces.push_back(surface(quad));
    for (const int layer : {inner, outer_layer})
      for (const Corner& corner : quads[std::size_t(layer)]) corners.push_back(point(corner));
    const int volume = gmsh::model::geo::addVolume({gmsh::model::geo::addSurfaceLoop(surfaces)});
    gmsh::model::geo::mesh::setTransfiniteVolume(volume, corners);
    volumes_.push_back(volume);
  }

  const std::vector<int>& volumes() const { return volumes_; }

  /// Tags of the surfaces all of whose corners satisfy `belongs`.
  template <class Predicate>
  std::vector<int> surfaces_where(Predicate belongs) const {
    std::vector<int> tags;
    for (const auto& [corners, tag] : surfaces_)
      if (std::ranges::all_of(corners, belongs)) tags.push_back(tag);
    return tags;
  }

 private:
  double radius(const Corner& corner) const {
    return corner.layer == inner ? geometry_.rod_radius : geometry_.tip_radius;
  }

  int point(const Corner& corner) {
    const auto found = points_.find(corner);
    if (found != points_.end()) return found->second;
    // Multiples of 45 degrees from a table, so that the symmetry planes are met exactly.
    constexpr double d = std::numbers::sqrt2 / 2;
    static constexpr std::array<double, 8> cosine{1, d, 0, -d, -1, -d, 0, d};
    const double c = cosine[std::size_t(corner.azimuth)];
    const double s = cosine[std::size_t(corner.azimuth + 6) % 8];
    const double r = radius(corner);
    double rho = r, z = 0;
    if (corner.ring == pole) {
      rho = 0, z = r;
    } else if (corner.ring == cap) {
      const double angle = options_.cap_angle * (corner.azimuth % 2 == 1 ? diagonal_stretch : 1.0);
      rho = r * std::sin(angle), z = r * std::cos(angle);
    } else if (corner.ring == end_ring) {
      z = -geometry_.sleeve_length;
    }
    return points_[corner] = gmsh::model::geo::addPoint(rho * c, rho * s, z);
  }

  /// The curve between two corners, directed from the smaller to the larger one.
  int curve(Corner a, Corner b) {
    if (b < a) std::swap(a, b);
    const auto found = curves_.find({a, b});
    if (found != curves_.end()) return found->second;
    const bool straight = a.layer != b.layer || (a.ring != b.ring && b.ring == end_ring);
    const int centre = a.ring == end_ring ? end_centre_ : centre_;
    const int tag = straight ? gmsh::model::geo::addLine(point(a), point(b))
                             : gmsh::model::geo::addCircleArc(point(a), centre, point(b));
    divide(tag, a, b);
    return curves_[{a, b}] = tag;
  }

  /// Sets the element count and grading of a curve.
  void divide(int tag, const Corner& a, const Corner& b) const {
    using gmsh::model::geo::mesh::setTransfiniteCurve;
    if (a.layer != b.layer) {
      // gmsh's "Bump" makes the ends finer by this coefficient.
      setTransfiniteCurve(tag, options_.radial_elements + 1, "Bump", 1.0 / options_.radial_grading);
      return;
    }
    int elements = options_.cap_elements;
    if (a.ring == cap && b.ring == equator) elements = options_.ring_elements;
    if (a.ring == equator && b.ring == end_ring) elements = options_.sleeve_elements;
    // gmsh interpolates a face from the division of two of its sides, so opposite sides must be
    // divided alike: what the cap's grading does to its meridians it does to all arcs around.
    double last_over_first = 1.0;
    if (a.ring == pole) last_over_first = options_.cap_grading;
    if (a.ring == b.ring)
      last_over_first = a.azimuth % 2 == 0 ? options_.cap_grading : 1.0 / options_.cap_grading;
    setTransfiniteCurve(tag, elements + 1, "Progression",
                        std::pow(last_over_first, 1.0 / (elements - 1)));
  }

  int surface(const Quad& corners) {
    Quad key = corners;
    std::ranges::sort(key);
    const auto found = surfaces_.find(key);
    if (found != surfaces_.end()) return found->second;
    std::vector<int> loop, points;
    for (std::size_t i = 0; i < 4; ++i) {
      const Corner &from = corners[i], &to = corners[(i + 1) % 4];
      loop.push_back(from < to ? curve(from, to) : -curve(from, to));
      points.push_back(point(from));
    }
    const bool on_sphere = std::ranges::all_of(corners, [&](const Corner& corner) {
      return corner.layer == corners[0].layer && corner.ring != end_ring;
    });
    const int tag = gmsh::model::geo::addSurfaceFilling({gmsh::model::geo::addCurveLoop(loop)}, -1,
                                                        on_sphere ? centre_ : -1);
    gmsh::model::geo::mesh::setTransfiniteSurface(tag, "Left", points);
    gmsh::model::geo::mesh::setRecombine(2, tag);
    return surfaces_[key] = tag;
  }

  const Geometry& geometry_;
  const TipMeshOptions& options_;
  int centre_ = 0, end_centre_ = 0;
  std::map<Corner, int> points_;
  std::map<std::pair<Corner, Corner>, int> curves_;
  std::map<Quad, int> surfaces_;
  std::vector<int> volumes_;
};

void add_quarter(BlockStructure& blocks, int first_azimuth, bool sleeve) {
  const int a0 = first_azimuth, a1 = a0 + 1, a2 = (a0 + 2) % 8;
  blocks.add_block({Corner{0, pole, 0}, {0, cap, a0}, {0, cap, a1}, {0, cap, a2}});
  for (const auto& [from, to] : {std::pair{a0, a1}, std::pair{a1, a2}}) {
    blocks.add_block({Corner{0, cap, from}, {0, equator, from}, {0, equator, to}, {0, cap, to}});
    if (sleeve)
      blocks.add_block(
          {Corner{0, equator, from}, {0, end_ring, from}, {0, end_ring, to}, {0, equator, to}});
  }
}

void name_groups(const BlockStructure& blocks, bool sleeve, Sector sector) {
  name_group(3, blocks.volumes(), PhysicalTag::tip, "tip");
  name_group(2, blocks.surfaces_where([](const Corner& c) { return c.layer == outer_layer; }),
             PhysicalTag::outer, "outer");
  name_group(2, blocks.surfaces_where([](const Corner& c) { return c.layer == inner; }),
             PhysicalTag::bond, "bond");
  const int last = sleeve ? end_ring : equator;
  name_group(2, blocks.surfaces_where([last](const Corner& c) { return c.ring == last; }),
             PhysicalTag::end, "end");
  if (sector == Sector::full) return;
  const bool half = sector == Sector::half;
  if (!half)
    name_group(
        2, blocks.surfaces_where([](const Corner& c) { return c.ring == pole || c.azimuth == 2; }),
        PhysicalTag::symmetry_x, "symmetry_x");
  name_group(2, blocks.surfaces_where([half](const Corner& c) {
    return c.ring == pole || c.azimuth == 0 || (half && c.azimuth == 4);
  }),
             PhysicalTag::symmetry_y, "symmetry_y");
}

/// Moves the nodes of `surface` that gmsh left off the sphere or cylinder onto it.
void snap(PhysicalTag surface, double radius) {
  std::vector<std::size_t> tags;
  std::vector<double> coordinates;
  gmsh::model::mesh::getNodesForPhysicalGroup(2, int(surface), tags, coordinates);
  for (std::size_t i = 0; i < tags.size(); ++i) {
    const Vector3 w(coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]);
    const double factor = radius / Geometry::radial_distance(w);
    const double x = w.x() * factor, y = w.y() * factor;
    const double z = w.z() > 0 ? w.z() * factor : w.z();
    gmsh::model::mesh::setNode(tags[i], {x, y, z}, {});
  }
}

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
    const bool sleeve = geometry.sleeve_length > 0.0;
    BlockStructure blocks(geometry, options);
    const int azimuths = options.sector == Sector::full   ? 8
                         : options.sector == Sector::half ? 4
                                                          : 2;
    for (int azimuth = 0; azimuth < azimuths; azimuth += 2) add_quarter(blocks, azimuth, sleeve);
    gmsh::model::geo::synchronize();
    name_groups(blocks, sleeve, options.sector);
    gmsh::model::mesh::generate(3);
    snap(PhysicalTag::outer, geometry.tip_radius);
    snap(PhysicalTag::bond, geometry.rod_radius);
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

TipMeshOptions TipMeshOptions::refined(double factor) const {
  TipMeshOptions result = *this;
  for (int* count : {&result.cap_elements, &result.ring_elements, &result.sleeve_elements,
                     &result.radial_elements})
    *count = std::max(2, int(std::lround(*count * factor)));
  return result;
}

std::vector<Violation> TipMeshOptions::violations() const {
  std::vector<Violation> broken;
  const auto require = [&](bool valid, const char* key, double value, const char* rule,
                           const char* remedy) {
    if (!valid) broken.push_back({std::string("mesh.") + key, std::to_string(value), rule, remedy});
  };
  for (const auto& [key, count] :
       {std::pair{"cap_elements", cap_elements}, std::pair{"ring_elements", ring_elements},
        std::pair{"sleeve_elements", sleeve_elements},
        std::pair{"radial_elements", radial_elements}})
    require(count >= 2 && count <= 500, key, count, "must be between 2 and 500",
            "choose a count in this range");
  for (const auto& [key, ratio] :
       {std::pair{"cap_grading", cap_grading}, std::pair{"radial_grading", radial_grading}})
    require(ratio >= 1.0 && ratio <= 20.0, key, ratio, "must be between 1 and 20",
            "choose 1 for equal elements");
  require(cap_angle >= 0.2 && cap_angle <= 1.2, "cap_angle", cap_angle,
          "must be between 0.2 and 1.2 rad", "keep the cap off the pole and the equator");
  return broken;
}

MeshQuality write_tip_mesh(const Geometry& geometry, const TipMeshOptions& options,
                           const std::filesystem::path& file) {
  std::vector<Violation> broken = geometry.violations();
  for (const Violation& violation : options.violations()) broken.push_back(violation);
  if (!broken.empty()) throw InvalidInput(broken);
  try {
    return mesh_tip(geometry, options, file);
  } catch (const std::string& message) {  // gmsh's way of failing
    throw NotConverged("gmsh could not mesh the tip: " + message);
  }
}

}  // namespace fingertip::meshes
