/// Fingers of other files than STL, as triangles.
#pragma once

#include <filesystem>
#include <string>

namespace fingertip::studies::inline config::inline shapes {

/// An STL file with the surface of the one solid in a STEP or BREP file, to about 1e-4 of its size
/// and finer at the end that `up` ("+z", "-y", ...) points to, which touches first,
/// or of the body that the meridian of a CSV file sweeps (meshes/shape/revolved_surface.h). In mm;
/// BREP: in the file's unit. Made once for each content and kept in the cache; of a CAD solid
/// fingertip-fem makes it. Throws InvalidInput (geometry.file; of a meridian, a line of the file)
/// with what is wrong with the file, or when that program is not there.
std::filesystem::path triangulated(const std::filesystem::path& file, const std::string& up = "+z");

}  // namespace fingertip::studies::inline config::inline shapes
