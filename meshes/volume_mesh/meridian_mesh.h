/// The meridian of a body of revolution as entities of gmsh's present model, of the mesher's own.
#pragma once

#include <vector>

#include "meshes/volume_mesh/mesh_options.h"

namespace fingertip::meshes::inline volume_mesh {

/// Makes a physical group of these entities; none when there are none.
void name_group(int dimension, const std::vector<int>& tags, PhysicalTag tag, const char* name);

/// Two transfinite blocks, or one without a sleeve. Names the physical groups, as does the next.
void build_dome_meridian(const Geometry& geometry, const TipMeshOptions& options);

/// Quadrilaterals of a profile, smallest at its pole, of about the size of the dome's blocks.
void build_meridian(const Geometry& geometry, const TipMeshOptions& options);

}  // namespace fingertip::meshes::inline volume_mesh
