/// Where the programs and what they keep are.
#pragma once

#include <filesystem>
#include <string>

namespace fingertip::studies::inline files {

/// The folder of the project's programs: where this code's own file is, or of the Python module the
/// nearest `bin` above it that has them.
std::filesystem::path executable_folder();

/// A folder of data: PREFIX/share/fingertip/NAME where the programs are installed, else `source`.
std::filesystem::path data_folder(const std::string& name, const std::filesystem::path& source);

/// What the programs pass on or start: beside them as built, or in PREFIX's library folder.
std::filesystem::path passed_on(const std::string& name);

/// fingertip-fem there; need not exist.
std::filesystem::path reference_program();

/// $XDG_CACHE_HOME/fingertip, else ~/.cache/fingertip.
std::filesystem::path cache_folder();

}  // namespace fingertip::studies::inline files
