/// What people type around a value.
#pragma once

#include <string_view>

namespace fingertip::studies::inline config::inline text {

/// Without white space at both ends; line feeds, which separate, stay.
inline std::string_view trimmed(std::string_view text) {
  constexpr const char* blank = " \t\r\v\f";
  const auto first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

}  // namespace fingertip::studies::inline config::inline text
