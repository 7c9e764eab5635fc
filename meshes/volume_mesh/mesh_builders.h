/// The ways to mesh a finger, of the mesher's own: into gmsh's current model, with physical groups.
#pragma once

#include <vector>

#include "meshes/volume_mesh/mesh_options.h"

namespace fingertip::meshes::inline volume_mesh {

/// Makes a physical group of these entities; none when there are none.
void name_group(int dimension, const std::vector<int>& tags, PhysicalTag tag, const char* name);

/// Block-structured hexahedra of the dome; nodes of the boundary lie on sphere and cylinder.
void build_dome_mesh(const Geometry& geometry, const TipMeshOptions& options);

/// Hexahedra of a finger of any shape: tetrahedra within its surface, each divided into four; nodes
/// of the boundary lie on the true surface. Throws NotConverged when no size of tetrahedra gives
/// hexahedra that are not inside out.
void build_split_mesh(const Geometry& geometry, const TipMeshOptions& options);

/// The meridian's blocks of the dome, two transfinite ones or one without a sleeve; still to be
/// meshed, as is the next.
void build_dome_meridian(const Geometry& geometry, const TipMeshOptions& options);

/// Quadrilaterals of a profile, smallest at its pole, of about the size of the dome's blocks.
void build_meridian(const Geometry& geometry, const TipMeshOptions& options);

}  // namespace fingertip::meshes::inline volume_mesh
