/// Numbers for people: in the units of run.units, typographic signs, no line break before a unit.
#pragma once

#include <string>

#include "studies/files/shown_units.h"

namespace fingertip::studies::report::inline figure {

inline constexpr double degree_per_radian = 57.29577951308232;

/// `value` with `digits` significant digits, "–" for NaN; fixed notation from 1e-3 to 1e6, powers
/// of ten as "1.2×10⁻⁹" outside.
std::string number(double value, int digits = 4);

/// The same without the digits that `error` leaves open: none behind its second one. "0" for a
/// value below that; all `digits` where the error is unknown or zero.
std::string number_with_error(double value, double error, int digits = 4);

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

/// "3 mm", in the paper's units "0.3 cm (3 mm)".
std::string length(double metre);
/// "190.5 mN", in the paper's units "19.42 gf (190.5 mN)".
std::string force(double newton);
/// "3.923 kPa", in the paper's units "40.00 gf/cm² (3.923 kPa)".
std::string stress(double pascal);
/// SI alone, with the prefix that suits: "3.923 kPa", "190.5 mN", "43.1 µs".
std::string with_prefix(double value, const std::string& unit);
/// In the unit of run.units where its table has the quantity, else with a prefix: "0.1382 mm".
std::string amount(double value, const std::string& si_unit);
/// What a file says of its result, in SI, with its amounts as this page shows them.
std::string as_shown(const std::string& statement);
/// SI for the line below a number that is shown in the paper's units; nothing where it is in SI.
std::string si_note(double value, const std::string& unit);
/// "190.5 mN" or "19.42 gf": the number as a table shows it, and its unit.
std::string with_unit(double value, const ShownUnit& unit, int digits = 4);
/// "mm", as a cell's note takes it.
std::string unit_name(const ShownUnit& unit);

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

}  // namespace fingertip::studies::report::inline figure
