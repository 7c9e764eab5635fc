#include "meshes/volume_mesh/mesh_builders.h"

#include <gmsh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace fingertip::meshes::inline volume_mesh {
namespace {

/// The diagonal corner of the cap lies this much further from the pole than the two on the
/// meridians: it opens the obtuse angle of that corner (measured in README).
constexpr double diagonal_stretch = 1.2;

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

}  // namespace

void build_dome_mesh(const Geometry& geometry, const TipMeshOptions& options) {
  const bool sleeve = geometry.sleeve_length > 0.0;
  BlockStructure blocks(geometry, options);
  const int azimuths = options.sector == Sector::full ? 8 : options.sector == Sector::half ? 4 : 2;
  for (int azimuth = 0; azimuth < azimuths; azimuth += 2) add_quarter(blocks, azimuth, sleeve);
  gmsh::model::geo::synchronize();
  name_groups(blocks, sleeve, options.sector);
  gmsh::model::mesh::generate(3);
  snap(PhysicalTag::outer, geometry.tip_radius);
  snap(PhysicalTag::bond, geometry.rod_radius);
}

}  // namespace fingertip::meshes::inline volume_mesh
