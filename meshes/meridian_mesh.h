/// The meridian of a body of revolution as entities of gmsh's present model, of the mesher's own.
#pragma once

#include "meshes/geometry.h"
#include "meshes/volume_mesh.h"

namespace fingertip::meshes {

/// Two transfinite blocks, or one without a sleeve. Names the physical groups, as does the next.
void build_dome_meridian(const Geometry& geometry, const TipMeshOptions& options);

/// Quadrilaterals of a profile, smallest at its pole, of about the size of the dome's blocks.
void build_meridian(const Geometry& geometry, const TipMeshOptions& options);

}  // namespace fingertip::meshes
