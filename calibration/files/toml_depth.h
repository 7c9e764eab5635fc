/// A guard for the TOML parser.
#pragma once

#include <string_view>

namespace fingertip::calibration::inline files {

/// Whether a key of `toml` has hundreds of dotted parts. toml++ limits the nesting of brackets, but
/// makes a table per part of a dotted key, and takes them apart by recursion: some ten thousand
/// exhaust the stack. Texts may have as many dots between two commas, brackets or line ends.
inline bool nests_too_deep(std::string_view toml) {
  constexpr int most = 250;
  int dots = 0;
  for (const char c : toml) {
    if (c == '.') ++dots;
    if (dots > most) return true;
    if (std::string_view(",=[]{}#\n").find(c) != std::string_view::npos) dots = 0;
  }
  return false;
}

}  // namespace fingertip::calibration::inline files
