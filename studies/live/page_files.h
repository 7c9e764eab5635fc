/// The page's own files, built into the program from page/.
#pragma once

#include <string_view>
#include <vector>

namespace fingertip::studies::inline live {

struct PageFile {
  std::string_view path;  ///< "/" + name below page/; index.html is "/"
  std::string_view type;  ///< MIME type
  std::string_view content;
};

const std::vector<PageFile>& page_files();

}  // namespace fingertip::studies::inline live
