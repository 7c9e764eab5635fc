/// The surface of a CAD solid as triangles, by gmsh and OpenCASCADE.
#pragma once

#include <filesystem>
#include <string>

namespace fingertip::meshes::inline volume_mesh {

/// Writes the surface of the one solid in a STEP or BREP file as a binary STL file, in the file's
/// numbers (STEP: mm), to about 1e-4 of its size: vertices on the surface, finer where it is more
/// curved and at the top, the end that `up` points to ("+z", "-y", ...), which touches first. Faces
/// that have names in a STEP file keep them. Throws InvalidInput when there is no solid, or more
/// than one, or no mesh of it.
void write_cad_surface(const std::filesystem::path& cad, const std::filesystem::path& stl,
                       const std::string& up = "+z");

}  // namespace fingertip::meshes::inline volume_mesh
