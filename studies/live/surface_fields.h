/// The deformed surface of a continuum, read from the .vtu files that deal.II writes.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "meshes/shape/geometry.h"

namespace fingertip::studies::inline live {

/// Points of a surface and the edges between them.
struct SurfaceMesh {
  std::vector<meshes::Vector3> rest;          ///< [m]
  std::vector<meshes::Vector3> displacement;  ///< [m], as many
  std::vector<std::array<std::uint32_t, 2>> edges;
};

/// Points, hexahedra and the vector field `displacement` of a .vtu: XML with inline base64 arrays,
/// compressed by zlib or not (VTK file formats, "XML unstructured grid"). Throws InvalidInput,
/// naming the file, for everything else.
struct HexahedralField {
  std::vector<meshes::Vector3> points, displacement;  ///< [m]; elements do not share points
  std::vector<std::array<std::uint32_t, 8>> cells;    ///< VTK order
};
HexahedralField read_vtu(const std::filesystem::path& file);

/// The edges of those faces that belong to one cell only and lie, undeformed, on the tip's outer
/// surface: all of their corners as far from the axis or the centre as the farthest point is.
/// Coincident points become one.
SurfaceMesh outer_surface(const HexahedralField& field);

/// With the mirror images in x = 0 and y = 0 added, in each of the two where the mesh ends there.
SurfaceMesh completed(const SurfaceMesh& part);

}  // namespace fingertip::studies::inline live
