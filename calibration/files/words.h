/// Numbers in sentences.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace fingertip::calibration::inline files {

/// To so many significant digits, without trailing zeros.
inline std::string rounded(double value, int digits = 4) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

/// The same with its SI unit behind it, from which `in_shown_units` makes what people read; "1": a
/// number without one.
inline std::string quantity_text(double value, std::string_view unit, int digits = 5) {
  return rounded(value, digits) + (unit == "1" ? "" : " " + std::string(unit));
}

/// Of sentences without a full stop one.
inline std::string in_one(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += (text.empty() ? "" : "; ") + sentence;
  return text;
}

/// A share [-] in percent, to so many digits, and whole where that is more.
inline std::string percent(double share, int digits = 2) {
  const double hundredths = 100.0 * share;
  const bool whole = std::abs(hundredths) >= std::pow(10.0, digits) - 0.5;
  return (whole ? rounded(std::round(hundredths), 9) : rounded(hundredths, digits)) + " %";
}

}  // namespace fingertip::calibration::inline files
