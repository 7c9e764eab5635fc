/// Where the programs and what they keep are.
#pragma once

#include <filesystem>

namespace fingertip::studies {

/// The folder of the project's programs: where this code's own file is, or of the Python module
/// the programs' one beside it, `bin`.
std::filesystem::path executable_folder();

/// fingertip-fem there; need not exist.
std::filesystem::path reference_program();

/// $XDG_CACHE_HOME/fingertip, else ~/.cache/fingertip.
std::filesystem::path cache_folder();

}  // namespace fingertip::studies
