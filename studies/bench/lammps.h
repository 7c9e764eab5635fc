/// The cube of springs as a peer marches it.
#pragma once

#include <cstddef>
#include <filesystem>

namespace fingertip::studies::inline bench {

/// Writes what `fingertip export` writes for a free cube of size³ masses with springs to their 26
/// neighbours (published model, undamped, agitated), to be marched `steps` steps without frames.
/// Returns the number of springs.
std::size_t write_lammps_cube(const std::filesystem::path& folder, int size, long steps);

}  // namespace fingertip::studies::inline bench
