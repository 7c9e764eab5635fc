/// Where the programs and what they keep are.
#pragma once

#include <filesystem>

namespace fingertip::studies {

/// The folder of this executable.
std::filesystem::path executable_folder();

/// fingertip-fem beside this executable; need not exist.
std::filesystem::path reference_program();

/// $XDG_CACHE_HOME/fingertip, else ~/.cache/fingertip.
std::filesystem::path cache_folder();

}  // namespace fingertip::studies
