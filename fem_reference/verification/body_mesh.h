/// Bodies for which exact solutions exist, as meshes. deal.II's side.
#pragma once

#include <array>

#include "fem_reference/elements/body.h"
#include "meshes/shape/geometry.h"

namespace fingertip::fem_reference::inline verification {

/// What the body is; x, y, z are the entries of BodyMesh::size.
enum class Shape {
  block,             ///< origin_i <= w_i <= origin_i + size_i, straight-sided hexahedra
  curved_block,      ///< the block bent by a smooth map of gradient up to 0.4, curved hexahedra
  sphere_octant,     ///< x <= |w| <= y, all coordinates >= 0; size z unused
  cylinder_quarter,  ///< x <= sqrt(w_x² + w_y²) <= y, w_x, w_y >= 0, 0 <= w_z <= z
  disc_octant,       ///< sqrt(w_x² + w_y²) <= x, w_x, w_y >= 0, 0 <= w_z <= z; size y unused
  // Bodies of revolution on their meridians, w_x the distance from the axis.
  ring,               ///< the block's section, origin_x >= 0
  curved_ring,        ///< bent as the block is, except where it meets the axis
  sphere_meridian,    ///< the octant's section
  cylinder_meridian,  ///< the quarter's section
  disc_meridian,      ///< the octant's section
};

/// Whether the body is meshed by its meridian alone.
inline bool revolved(Shape shape) {
  return shape >= Shape::ring;
}

/// How a body of revolution is meshed.
enum class Meshed { solid, meridian };

/// Boundary numbers. Blocks: 2 i and 2 i + 1 for the faces of low and high coordinate i; rings: the
/// same without y.
namespace boundary {
inline constexpr int low_x = 0, high_x = 1, low_y = 2, high_y = 3, low_z = 4, high_z = 5;
inline constexpr int inner = 6, outer = 7;  ///< of sphere and cylinder; outer: the disc's side
inline constexpr int count = 8;
}  // namespace boundary

/// A body and how finely it is meshed.
struct BodyMesh {
  Shape shape = Shape::block;
  meshes::Vector3 size = meshes::Vector3::Ones();    ///< [m], see Shape
  meshes::Vector3 origin = meshes::Vector3::Zero();  ///< low corner of a block [m]
  /// Elements along the three directions: x, y, z of a block, radius, angle, z of a cylinder. The
  /// octants take the first alone, a power of two: elements along each coarse edge, of which the
  /// sphere's octant has one through its wall, the disc's two along its radius and one in z.
  std::array<int, 3> divisions{1, 1, 1};
  /// Vertices inside a block are moved at random by up to this share of their shortest edge.
  double distortion = 0.0;
  /// So often are the elements halved that touch the low corner of a block or the edge where
  /// the disc's side meets its bonded face w_z = z; hanging nodes arise.
  int local_refinements = 0;
};

/// Meshes `description` into the empty body and leaves its unknowns unnumbered. Throws
/// std::invalid_argument for divisions that the shape does not allow.
void make_mesh(const BodyMesh& description, Body<3>& body);
void make_mesh(const BodyMesh& description, Body<2>& body);

}  // namespace fingertip::fem_reference::inline verification
