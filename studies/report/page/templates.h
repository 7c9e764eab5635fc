/// The mustache templates of this folder, built into the program.
#pragma once

#include <string>
#include <string_view>

namespace fingertip::studies::report::inline page {

/// The text of chapters/`name`.mustache, or of the page itself, "report".
std::string_view template_text(const std::string& name);

}  // namespace fingertip::studies::report::inline page
