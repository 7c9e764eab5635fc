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

/// A share [-] in percent, to two digits, from 100 % on to whole ones.
inline std::string percent(double share) {
  const double hundredths = 100.0 * share;
  return (std::abs(hundredths) < 100.0 ? rounded(hundredths, 2)
                                       : rounded(std::round(hundredths), 9)) +
         " %";
}

}  // namespace fingertip::calibration::inline files
