/// SHA-256, by which results are recognised in the cache.
#pragma once

#include <string>
#include <string_view>

namespace fingertip::studies::inline jobs {

/// 64 hexadecimal digits.
std::string sha256(std::string_view text);

}  // namespace fingertip::studies::inline jobs
