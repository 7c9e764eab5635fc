/// Numbers for people: gf and cm beside SI, typographic signs, no line break before a unit.
#pragma once

#include <string>

namespace fingertip::studies::reporting {

inline constexpr double newton_per_gf = 9.80665e-3;       ///< standard gravity times 1 g
inline constexpr double pascal_per_gf_per_cm2 = 98.0665;  ///< 1 gf over 1 cm²
inline constexpr double degree_per_radian = 57.29577951308232;

inline double to_gf(double newton) {
  return newton / newton_per_gf;
}
inline double to_gf_per_cm2(double pascal) {
  return pascal / pascal_per_gf_per_cm2;
}
inline double to_cm(double metre) {
  return metre * 100.0;
}

/// `value` with `digits` significant digits, "–" for NaN; fixed notation from 1e-3 to 1e6, powers
/// of ten as "1.2×10⁻⁹" outside.
std::string number(double value, int digits = 4);

/// "10⁻⁹"
std::string power_of_ten(int exponent);

/// A whole number with thin spaces between thousands.
std::string count(double value);

/// A signed relative error: 0.031 becomes "+3.1 %"; two significant digits below 1 %, and
/// anything below 1e-8 in magnitude is "0 %": that is round-off of the files, not a result.
std::string percent(double fraction);

/// The same without a sign, for a magnitude.
std::string percent_magnitude(double fraction);

/// Between a number and its unit: U+00A0.
inline constexpr const char* gap = "\u00a0";

/// "0.3 cm (3 mm)"
std::string length(double metre);
/// "19.42 gf (0.1905 N)"
std::string force(double newton);
/// "40 gf/cm² (3.923 kPa)"
std::string stress(double pascal);
/// SI alone, with the prefix that suits: "3.923 kPa", "190.5 mN", "43.1 µs".
std::string with_prefix(double value, const std::string& unit);

/// How far a relative error is off, for colours and marks.
enum class Grade { none, close, fair, off, wrong };

/// |error| <= 2 % close, <= 10 % fair, <= 30 % off, beyond wrong; NaN none.
Grade grade(double relative_error);

/// Name used as CSS class.
std::string css_class(Grade grade);

/// A mark that tells the grades apart without colour.
std::string mark(Grade grade);

/// The names in a row, "a, b and c".
template <class Strings>
std::string enumerate(const Strings& names) {
  std::string text;
  std::size_t left = names.size();
  for (const auto& name : names) {
    text += name;
    --left;
    if (left > 1) text += ", ";
    if (left == 1) text += " and ";
  }
  return text;
}

}  // namespace fingertip::studies::reporting
