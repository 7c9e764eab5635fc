/// Solids of CAD programs as triangles.
#pragma once

#include <filesystem>

namespace fingertip::studies {

/// An STL file with the surface of the one solid in a STEP or BREP file, to about 1e-4 of its size
/// (STEP: in mm; BREP: in the file's unit). fingertip-fem makes it, once for each content: it is
/// kept in the cache. Throws InvalidInput (geometry.file) with what is wrong with the file, or when
/// that program is not there.
std::filesystem::path triangulated(const std::filesystem::path& cad);

}  // namespace fingertip::studies
