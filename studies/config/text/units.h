/// Quantities with units at the edge of the program: text in, SI numbers out, and back.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace fingertip::studies::inline config::inline text {

/// A text that is not a quantity of the wanted dimension.
class UnitError : public std::runtime_error {
 public:
  UnitError(std::string broken_rule, std::string advice)
      : std::runtime_error(broken_rule + "; " + advice),
        rule(std::move(broken_rule)),
        remedy(std::move(advice)) {}
  std::string rule;
  std::string remedy;
};

/// Reads "40 gf/cm^2" into the SI unit `unit` ("Pa", "m", "kg/m^3", "s", "Hz", ...), using
/// UDUNITS-2 plus the unit gf (gram-force, 9.80665e-3 N). `example` is quoted in the advice.
/// Throws UnitError when there is no finite number, no unit, an unknown unit, or a unit of another
/// dimension. Reciprocal units (s for Hz), units with an offset (degC), angles for plain
/// frequencies (rad/s for Hz, a silent factor 2 pi) and plain numbers for angles (5 %) count as
/// another dimension.
double parse_quantity(std::string_view text, const std::string& unit, const std::string& example);

/// `value`, given in the SI unit `from`, expressed in `to`: convert(1, "Pa", "gf/cm^2") = 0.0102.
/// Throws UnitError when the units do not go together.
double convert(double value, const std::string& from, const std::string& to);

}  // namespace fingertip::studies::inline config::inline text
