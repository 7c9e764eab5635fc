/// Writing files so that a reader never sees half of one.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>

namespace fingertip::meshes::inline base {

/// Writes `file` through a temporary name in the same folder and renames it when complete.
/// Throws CannotWrite (cannot_write.h) naming the file when it cannot be written.
void write_atomically(const std::filesystem::path& file,
                      const std::function<void(std::ostream&)>& write);

/// The shortest decimal text that reads back as exactly `value`; empty for NaN.
std::string to_text(double value);

}  // namespace fingertip::meshes::inline base
