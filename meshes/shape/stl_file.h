/// Triangles as an STL file.
#pragma once

#include <filesystem>
#include <string>

#include "meshes/shape/triangle_mesh.h"

namespace fingertip::meshes::inline shape {

/// Writes an STL file of the mesh, its lengths in units of `unit` [m]: binary, or a text with a
/// solid for each face where faces have names. `title`: at most 80 letters, not beginning with
/// "solid". Throws CannotWrite.
void write_stl(const TriangleMesh& mesh, double unit, const std::string& title,
               const std::filesystem::path& file);

}  // namespace fingertip::meshes::inline shape
