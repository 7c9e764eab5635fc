/// Hexahedra of a finger of any shape: tetrahedra within its surface, each divided into four.
#pragma once

#include "meshes/volume_mesh/mesh_options.h"

namespace fingertip::meshes::inline volume_mesh {

/// Into gmsh's current model, with physical groups; nodes of the boundary lie on the true surface.
/// Throws NotConverged when no size of tetrahedra gives hexahedra that are not inside out.
void build_split_mesh(const Geometry& geometry, const TipMeshOptions& options);

}  // namespace fingertip::meshes::inline volume_mesh
