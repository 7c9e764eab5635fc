/// The page as a folder of files that a browser opens without a server.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/web/web_press.h"

namespace fingertip::studies::inline web {

/// A finger that the page offers, at spacings from coarse to fine.
struct WebFinger {
  struct Choice {
    std::string spacing;  ///< "R/8"
    WebPress press;
  };
  std::string name;
  std::vector<Choice> presses;
};
FINGERTIP_FIELDS(WebFinger::Choice, spacing, press);
FINGERTIP_FIELDS(WebFinger, name, presses);

/// The lattice as JavaScript that emscripten has made (module/). Need not exist.
std::filesystem::path module_file();

/// Writes the live view's page into `folder`, its connection replaced by the lattice and `fingers`.
/// Throws InvalidInput where a file of the page or the module is missing.
void write_page(const std::filesystem::path& folder, const std::vector<WebFinger>& fingers);

}  // namespace fingertip::studies::inline web
