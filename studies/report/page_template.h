/// The HTML template, built into the program from report.html.mustache.
#pragma once

#include <string_view>

namespace fingertip::studies::reporting {

std::string_view page_template();

}  // namespace fingertip::studies::reporting
