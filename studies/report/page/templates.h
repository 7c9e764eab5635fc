/// The mustache templates of the page and its chapters, built into the program.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace fingertip::studies::report::inline page {

/// By their file names, "press.mustache".
const std::map<std::string, std::string_view>& templates();

}  // namespace fingertip::studies::report::inline page
