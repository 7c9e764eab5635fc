/// What a mesh is worth.
#pragma once

#include "meshes/volume_mesh.h"

namespace fingertip::meshes {

/// Of the hexahedra, or else the quadrilaterals, in gmsh's current model. Throws what gmsh throws.
MeshQuality measure_mesh();

}  // namespace fingertip::meshes
