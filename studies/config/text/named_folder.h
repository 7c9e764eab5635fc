/// Files below folders that the environment names.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace fingertip::studies::inline config::inline text {

/// The variable in "$NAME/file"; empty: the text begins with none.
inline std::string variable_in(const std::string& written) {
  return written.starts_with('$') ? written.substr(1, written.find('/') - 1) : "";
}

/// The file that somebody names: "$NAME/..." is below the folder that the environment variable NAME
/// names, everything else below `base`. None where that variable is not set.
inline std::optional<std::filesystem::path> located(const std::string& written,
                                                    const std::filesystem::path& base) {
  const std::string variable = variable_in(written);
  if (variable.empty()) return base / written;
  const char* const folder = std::getenv(variable.c_str());
  if (folder == nullptr || *folder == '\0') return std::nullopt;
  return std::filesystem::path(folder) /
         written.substr(std::min(written.find('/'), written.size() - 1) + 1);
}

}  // namespace fingertip::studies::inline config::inline text
