/// The files of texts/: exported files and their README.md, with {name} or {name:format} where a
/// value is filled in.
#pragma once

#include <fmt/format.h>

#include <map>
#include <string>
#include <string_view>

namespace fingertip::studies::inline exchange {

const std::map<std::string, std::string_view>& texts();

/// The text of that name, filled with fmt::arg(name, value).
template <typename... Arguments>
std::string filled(const std::string& name, const Arguments&... arguments) {
  return fmt::vformat(texts().at(name), fmt::make_format_args(arguments...));
}

}  // namespace fingertip::studies::inline exchange
