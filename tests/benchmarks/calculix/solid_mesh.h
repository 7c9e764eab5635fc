/// The quarter tip's hexahedra as CalculiX wants them: corner nodes, or corners and mid-edge nodes.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <vector>

#include "meshes/geometry.h"

namespace fingertip::benchmarks {

/// Nodes are numbered from 0; node i is `nodes[i]` [m].
struct SolidMesh {
  std::vector<meshes::Vector3> nodes;
  /// Per element its nodes in Abaqus' order: bottom corners, top corners (both in the same sense),
  /// then the middles of the bottom, top and upright edges. The last 12 are unused when `corners`
  /// is all there is.
  std::vector<std::array<std::size_t, 20>> elements;
  bool quadratic = false;

  std::size_t nodes_per_element() const { return quadratic ? 20 : 8; }

  /// Indices of the nodes that satisfy `belongs(const Vector3&)`, ascending.
  template <class Predicate>
  std::vector<std::size_t> nodes_where(Predicate belongs) const {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (belongs(nodes[i])) found.push_back(i);
    return found;
  }
};

/// Element `element` and its face 1 ... 6 in Abaqus' numbering.
struct ElementFace {
  std::size_t element = 0;
  int face = 1;
};

/// Reads nodes and eight-node hexahedra of an ASCII MSH 4.1 file, as `meshes::write_tip_mesh`
/// writes it. Throws std::runtime_error naming the file when it is not of this form.
SolidMesh read_solid_mesh(const std::filesystem::path& file);

/// The same elements with a node on the middle of every edge: at the mean radius of the edge's
/// ends along the mean of their directions from the core (the centre above the equator, the axis
/// below), so that both surfaces stay round, as fingertip-fem's own elements have it.
SolidMesh with_midside_nodes(const SolidMesh& linear);

/// Element faces whose four corners all lie on the outer surface and above `lowest` [m].
std::vector<ElementFace> outer_faces(const SolidMesh& mesh, const meshes::Geometry& geometry,
                                     double lowest);

}  // namespace fingertip::benchmarks
