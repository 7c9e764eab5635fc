#include "studies/report/figure/format.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace fingertip::studies::report::inline figure {
namespace {

const std::string minus = "−";

/// fmt's ASCII hyphen as a minus sign.
std::string typeset(std::string text) {
  if (!text.empty() && text.front() == '-') text.replace(0, 1, minus);
  return text;
}

bool paper_units() {
  return shown_units().system == UnitSystem::paper;
}

std::string with_si(double value, const ShownUnit& unit) {
  const std::string si = with_prefix(value, std::string(unit.si));
  return paper_units() ? fmt::format("{} ({})", with_unit(value, unit), si) : si;
}

std::string percent_digits(double fraction) {
  const double magnitude = std::abs(100.0 * fraction);
  if (magnitude < 1e-6) return "0";
  if (magnitude < 0.01 || magnitude >= 1e6) return number(magnitude, 2);
  return fmt::format("{:.{}f}", magnitude, magnitude < 1.0 ? 2 : magnitude < 99.95 ? 1 : 0);
}

}  // namespace

std::string number_with_error(double value, double error, int digits) {
  if (!std::isfinite(value) || value == 0.0 || !(error > 0.0) || std::isinf(error))
    return number(value, digits);
  const auto exponent = [](double x) { return int(std::floor(std::log10(std::abs(x)))); };
  const int known = exponent(value) - (exponent(error) - 1) + 1;
  return known < 1 ? "0" : number(value, std::min(digits, known));
}

std::string power_of_ten(int exponent) {
  static const std::array<std::string, 10> digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "10⁻" : "10";
  for (char digit : std::to_string(std::abs(exponent))) text += digits[std::size_t(digit - '0')];
  return text;
}

std::string number(double value, int digits) {
  if (!std::isfinite(value)) return "–";
  if (value == 0.0) return "0";
  const std::string scientific = fmt::format("{:.{}e}", value, digits - 1);
  const std::size_t e = scientific.find('e');
  const int exponent = std::atoi(scientific.c_str() + e + 1);
  if (exponent >= -3 && exponent < 6) {
    return typeset(fmt::format("{:.{}f}", value, std::max(0, digits - 1 - exponent)));
  }
  return typeset(scientific.substr(0, e)) + "×" + power_of_ten(exponent);
}

std::string count(double value) {
  if (!std::isfinite(value)) return "–";
  std::string text = fmt::format("{:.0f}", value);
  const std::size_t first = text.front() == '-' ? 1 : 0;
  for (std::size_t i = text.size(); i > first + 3; i -= 3) text.insert(i - 3, "\u202f");
  return typeset(text);
}

std::string percent(double fraction) {
  if (!std::isfinite(fraction)) return "–";
  const std::string digits = percent_digits(fraction);
  const std::string sign = digits == "0" ? "" : fraction < 0.0 ? minus : "+";
  return sign + digits + gap + "%";
}

std::string percent_magnitude(double fraction) {
  return std::isfinite(fraction) ? percent_digits(fraction) + gap + "%" : "–";
}

std::string length(double metre) {
  if (!std::isfinite(metre)) return "–";
  const auto in = [&](const ShownUnits& units) {
    return typeset(fmt::format("{:.4g}", units.length(metre))) + gap + unit_name(units.length);
  };
  const std::string si = in(units_of(UnitSystem::si));
  return paper_units() ? fmt::format("{} ({})", in(shown_units()), si) : si;
}

std::string force(double newton) {
  return with_si(newton, shown_units().force);
}

std::string stress(double pascal) {
  return with_si(pascal, shown_units().stress);
}

std::string si_note(double value, const std::string& unit) {
  return paper_units() ? with_prefix(value, unit) : "";
}

std::string with_unit(double value, const ShownUnit& unit, int digits) {
  return number(unit(value), digits) + (std::isfinite(value) ? gap + unit_name(unit) : "");
}

std::string unit_name(const ShownUnit& unit) {
  return std::string(unit.name);
}

std::string with_prefix(double value, const std::string& unit) {
  if (!std::isfinite(value)) return "–";
  static const std::array<const char*, 7> prefixes{"n", "µ", "m", "", "k", "M", "G"};
  int step = value == 0.0 ? 0 : int(std::floor(std::log10(std::abs(value)) / 3.0 + 1e-9));
  step = std::clamp(step, -3, 3);
  return number(value / std::pow(1000.0, step)) + gap + prefixes[std::size_t(step + 3)] + unit;
}

std::string amount(double value, const std::string& si_unit) {
  const ShownUnit* unit = shown_units().of(si_unit);
  return unit == nullptr ? with_prefix(value, si_unit) : with_unit(value, *unit);
}

std::string as_shown(const std::string& statement) {
  return in_shown_units(statement, Spelling::page);
}

Grade grade(double relative_error) {
  const double magnitude = std::abs(relative_error);
  if (!std::isfinite(magnitude)) return Grade::none;
  // 1.02 - 1 is a little more than 0.02 in binary.
  const double slack = 1e-12;
  if (magnitude <= 0.02 + slack) return Grade::close;
  if (magnitude <= 0.10 + slack) return Grade::fair;
  return magnitude <= 0.30 + slack ? Grade::off : Grade::wrong;
}

std::string css_class(Grade grade) {
  static constexpr const char* classes[] = {"", "close", "fair", "off", "wrong"};
  return classes[std::size_t(grade)];
}

std::string mark(Grade grade) {
  static constexpr const char* marks[] = {"", "●", "◐", "○", "✕"};
  return marks[std::size_t(grade)];
}

}  // namespace fingertip::studies::report::inline figure
