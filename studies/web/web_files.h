/// The page's connection to its own lattice, built into the program from page/.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace fingertip::studies::inline web {

const std::map<std::string, std::string_view>& web_files();

}  // namespace fingertip::studies::inline web
