/// A folder of its own for every run.
#pragma once

#include <filesystem>
#include <string>

namespace fingertip::studies::inline jobs {

/// Makes runs/<verb>-<YYYYmmdd-HHMMSS> in the current folder, with a number when that exists; of
/// several processes each gets another one.
std::filesystem::path make_run_folder(const std::string& verb);

}  // namespace fingertip::studies::inline jobs
