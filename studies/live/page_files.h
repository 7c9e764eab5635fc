/// The page's own files, built into the program from page/.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace fingertip::studies::inline live {

const std::map<std::string, std::string_view>& page_files();

}  // namespace fingertip::studies::inline live
