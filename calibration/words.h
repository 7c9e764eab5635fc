/// Numbers in sentences.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

namespace fingertip::calibration {

/// To so many significant digits, without trailing zeros.
inline std::string rounded(double value, int digits = 4) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

/// Of sentences without a full stop one.
inline std::string in_one(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += (text.empty() ? "" : "; ") + sentence;
  return text;
}

/// A share [-] in percent, to two digits.
inline std::string percent(double share) {
  return rounded(100.0 * share, 2) + " %";
}

}  // namespace fingertip::calibration
