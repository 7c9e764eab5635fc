/// Block-structured hexahedra of the dome, of the mesher's own.
#pragma once

#include "meshes/volume_mesh/mesh_options.h"

namespace fingertip::meshes::inline volume_mesh {

/// Into gmsh's current model, with physical groups; nodes of the boundary lie on sphere and
/// cylinder.
void build_dome_mesh(const Geometry& geometry, const TipMeshOptions& options);

}  // namespace fingertip::meshes::inline volume_mesh
