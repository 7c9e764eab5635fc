/// Exported files and their README.md as they will lie in the folder, with {name} or {name:format}
/// where a value is filled in.
#pragma once

#include <fmt/format.h>

#include <map>
#include <string>
#include <string_view>

namespace fingertip::studies::inline exchange::inline texts {

const std::map<std::string, std::string_view>& exported_texts();

/// The text of that name, filled with fmt::arg(name, value).
template <typename... Arguments>
std::string filled(const std::string& name, const Arguments&... arguments) {
  return fmt::vformat(exported_texts().at(name), fmt::make_format_args(arguments...));
}

}  // namespace fingertip::studies::inline exchange::inline texts
