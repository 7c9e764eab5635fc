/// The meridian's quadrilaterals as CalculiX wants them: corner nodes, or corners and mid-edge
/// nodes.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <filesystem>
#include <vector>

#include "meshes/shape/geometry.h"

namespace fingertip::benchmarks {

/// Distance from the axis and place along it [m].
using MeridianPoint = Eigen::Vector2d;

/// meshes::Geometry::radial_distance of a point on the meridian.
double distance_from_core(const MeridianPoint& point);

/// Nodes are numbered from 0.
struct MeridianMesh {
  std::vector<MeridianPoint> nodes;
  /// Per element its nodes in Abaqus' order: corners counter-clockwise in (r, z), then the middles
  /// of the edges from the first corner on. The last four are unused when `corners` is all there
  /// is.
  std::vector<std::array<std::size_t, 8>> elements;
  bool quadratic = false;

  std::size_t nodes_per_element() const { return quadratic ? 8 : 4; }

  /// Indices of the nodes that satisfy `belongs(const MeridianPoint&)`, ascending.
  template <class Predicate>
  std::vector<std::size_t> nodes_where(Predicate belongs) const {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (belongs(nodes[i])) found.push_back(i);
    return found;
  }
};

/// Element `element` and its edge 1 ... 4 in Abaqus' numbering, from corner to next corner.
struct ElementEdge {
  std::size_t element = 0;
  std::size_t edge = 1;
};

/// Reads nodes and four-node quadrilaterals of an ASCII MSH 4.1 file, as `meshes::write_tip_mesh`
/// writes it for Sector::meridian. Throws std::runtime_error naming the file when it is not of this
/// form.
MeridianMesh read_meridian_mesh(const std::filesystem::path& file);

/// The same elements with a node on the middle of every edge: at the mean distance of the edge's
/// ends from the core (the centre above the equator, the axis below), so that both surfaces stay
/// round, as fingertip-fem's own elements have it.
MeridianMesh with_midside_nodes(const MeridianMesh& linear);

/// A cylinder, its axis y from 0 to `height`, by across x along quadratic elements, the sizes of
/// both directions halved `grading` times towards the rim, where stuck ends are singular.
MeridianMesh cylinder_mesh(double radius, double height, int across, int along, int grading);

/// Element edges whose ends both lie on the outer surface and above `lowest` [m].
std::vector<ElementEdge> outer_edges(const MeridianMesh& mesh, const meshes::Geometry& geometry,
                                     double lowest);

}  // namespace fingertip::benchmarks
