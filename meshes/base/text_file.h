/// Reading a whole file as text.
#pragma once

#include <filesystem>
#include <string>

namespace fingertip::meshes::inline base {

/// The bytes of a regular file. Throws InvalidInput naming it when there is none of that name,
/// when something else (a folder, a pipe) stands in its place, or when it cannot be read.
std::string read_text(const std::filesystem::path& file);

}  // namespace fingertip::meshes::inline base
