/// The continuum's mesh of the tip, written by gmsh: block-structured hexahedra of a dome, divided
/// tetrahedra of any other shape, or quadrilaterals of a meridian.
#pragma once

#include <cstddef>
#include <filesystem>

#include "meshes/tables/file_fields.h"
#include "meshes/volume_mesh/mesh_options.h"

namespace fingertip::meshes::inline volume_mesh {

struct MeshQuality {
  std::size_t hexahedra = 0;  ///< quadrilaterals, of a meridian
  std::size_t nodes = 0;
  double min_jacobian = 0.0;  ///< smallest Jacobian determinant at a corner [m³, meridian m²]
  double min_scaled_jacobian = 0.0;  ///< smallest scaled Jacobian, 1 for a cube or square
  double volume = 0.0;  ///< of the straight-sided elements, or the body they sweep [m³]
};
consteval auto fields_of(const MeshQuality*) {
  return FINGERTIP_ALL_MEMBERS(MeshQuality, hexahedra, nodes, min_jacobian, min_scaled_jacobian,
                               volume)
      .newer("nodes min_jacobian");
}

/// Writes the mesh in MSH 4.1 format with the physical volume `tip` and the physical surfaces
/// `outer`, `bond`, `end` (of another shape what is free, if anything) and, for quarter and half,
/// `symmetry_y` (the plane y = 0), for the quarter `symmetry_x` (x = 0), too. A solid must be
/// `mirrored` in these planes, else the part at x, y >= 0 is no share of it. Lengths in metres.
/// Throws InvalidInput for a broken option, NotConverged when gmsh fails or when an element has a
/// non-positive Jacobian.
MeshQuality write_tip_mesh(const Geometry& geometry, const TipMeshOptions& options,
                           const std::filesystem::path& file);

/// Reads a mesh file and measures it. Throws InvalidInput when the file is missing or damaged,
/// holds neither hexahedra nor quadrilaterals of a meridian, or one with a non-positive Jacobian.
MeshQuality inspect_tip_mesh(const std::filesystem::path& file);

}  // namespace fingertip::meshes::inline volume_mesh
