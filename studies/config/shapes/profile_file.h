/// The file of a meridian (key geometry.profile).
#pragma once

#include <filesystem>
#include <vector>

#include "meshes/shape/geometry.h"

namespace fingertip::studies::inline config::inline shapes {

/// Reads a closed meridian, a row per corner in order: `r [UNIT],z [UNIT],surface,curve`, any unit
/// of length; columns are separated by commas, semicolons or tabs, and but for commas numbers may
/// have decimal commas; `surface` names the piece from this corner to the next (contact, bond,
/// free, axis), `curve` is empty (straight), `arc R C` with the circle's centre in the file's unit,
/// or `spline`. Throws InvalidInput naming file and line for rows that cannot be read; whether the
/// curve is a meridian is for meshes::Meridian to say.
std::vector<meshes::ProfileCorner> read_profile(const std::filesystem::path& file);

}  // namespace fingertip::studies::inline config::inline shapes
