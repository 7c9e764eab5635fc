/// Everything that the page is made of, by the names of its files.
#pragma once

#include <map>
#include <string>

namespace fingertip::studies::inline live {

/// page/ and three.js, which is read from where Debian's package has it. Throws InvalidInput when
/// it is not there.
std::map<std::string, std::string> page_texts();

}  // namespace fingertip::studies::inline live
