/// The name of a folder that is not there yet.
#pragma once

#include <filesystem>
#include <string>

namespace fingertip::studies {

/// runs/<verb>-<YYYYmmdd-HHMMSS> in the current folder, with a number when that exists.
std::filesystem::path fresh_run_folder(const std::string& verb);

}  // namespace fingertip::studies
