#include "studies/files/shown_units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <regex>
#include <vector>

namespace fingertip::studies::inline files {

namespace {

constexpr double gf = 9.80665e-3;  ///< standard gravity times 1 g [N]
constexpr double cm = 1e-2;        ///< [m]

/// mN, mm, kPa and mN/mm = N/m go together: no power of ten stands between them.
constexpr ShownUnits tables[] = {{UnitSystem::si,
                                  {"length", "m", "mm", "mm", 1e3},
                                  {"force", "N", "mN", "mN", 1e3},
                                  {"stress", "Pa", "kPa", "kPa", 1e-3},
                                  {"stiffness", "N/m", "N/m", "N/m", 1.0},
                                  {"torque", "N m", "mN mm", "mN mm", 1e6},
                                  {"speed", "m/s", "mm/s", "mm/s", 1e3},
                                  {"compliance", "m/N", "mm/N", "mm/N", 1e3},
                                  {"force rate", "N/s", "mN/s", "mN/s", 1e3}},
                                 {UnitSystem::paper,
                                  {"length", "m", "cm", "cm", 1.0 / cm},
                                  {"force", "N", "gf", "gf", 1.0 / gf},
                                  {"stress", "Pa", "gf/cm²", "gf/cm^2", cm* cm / gf},
                                  {"stiffness", "N/m", "gf/cm", "gf/cm", cm / gf},
                                  {"torque", "N m", "gf cm", "gf cm", 1.0 / (gf * cm)},
                                  {"speed", "m/s", "cm/s", "cm/s", 1.0 / cm},
                                  {"compliance", "m/N", "cm/gf", "cm/gf", gf / cm},
                                  {"force rate", "N/s", "gf/s", "gf/s", 1.0 / gf}}};

UnitSystem today = UnitSystem::si;

/// Of a number's text, without zeros in front and the exponent.
int digits_of(std::string_view number) {
  number = number.substr(0, number.find_first_of("eE"));
  number.remove_prefix(std::min(number.find_first_of("123456789"), number.size()));
  return int(std::ranges::count_if(number, [](char c) { return c >= '0' && c <= '9'; }));
}

/// With as many decimals as the largest needs for its digits; without an exponent unless it is huge
/// or tiny.
std::vector<std::string> alike(const std::vector<double>& values, int digits) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  const bool plain = largest == 0.0 || (largest >= 1e-4 && largest < 1e7);
  const int before = plain && largest > 0.0 ? int(std::floor(std::log10(largest))) : 0;
  std::vector<std::string> texts;
  for (const double value : values) {
    std::string& text =
        texts.emplace_back(plain ? fmt::format("{:.{}f}", value, std::max(0, digits - 1 - before))
                                 : fmt::format("{:.{}g}", value, digits));
    if (plain && text.find('.') != text.npos) {
      text.erase(text.find_last_not_of('0') + 1);
      if (text.ends_with('.')) text.pop_back();
    }
    if (text == "-0") text = "0";
  }
  return texts;
}

/// Amounts of one sentence, an estimate and its interval, in `unit`.
std::vector<std::string> converted(const std::vector<std::string>& amounts, const ShownUnit& unit) {
  int digits = 4;
  std::vector<double> values;
  for (const std::string& number : amounts) {
    digits = std::max(digits, digits_of(number));
    values.push_back(unit(std::strtod(number.c_str(), nullptr)));
  }
  return alike(values, digits);
}

}  // namespace

UnitSystem unit_system(std::string_view word) {
  return meshes::enumerator<UnitSystem>(word).value_or(UnitSystem::si);
}

std::string ShownUnit::label(std::string_view what) const {
  return fmt::format("{} [{}]", what, name);
}

std::string ShownUnit::text(double value) const {
  return fmt::format("{} {}", alike({factor * value}, 4).front(), name);
}

std::array<const ShownUnit*, 8> ShownUnits::all() const {
  return {&length, &force, &stress, &stiffness, &torque, &speed, &compliance, &force_rate};
}

const ShownUnit* ShownUnits::of(std::string_view si) const {
  const auto units = all();
  const auto found = std::ranges::find(units, si, &ShownUnit::si);
  return found == units.end() ? nullptr : *found;
}

const ShownUnits& units_of(UnitSystem system) {
  return tables[std::size_t(system)];
}

const ShownUnits& shown_units() {
  return units_of(today);
}

std::string in_shown_units(std::string_view words, Spelling spelling) {
  // An amount, perhaps with its interval behind it; longer units first. Of bounded length: files
  // may be damaged, and the library's search takes stack for every character that repeats.
  static const std::regex amount(
      R"((^|[^\w.+-]|\+-)([-+]?\d{1,20}(?:\.\d{1,20})?(?:e[-+]?\d{1,3})?) )"
      R"((N/m|N m|N/s|m/N|m/s|Pa|N|m)(?![\w/^]))"
      R"((?:( \(95 %: )([-+.e\d]{1,24})( to )([-+.e\d]{1,24}))?)",
      std::regex::optimize);
  std::string text;
  auto rest = words.begin();
  for (std::cregex_iterator found(words.data(), words.data() + words.size(), amount), end;
       found != end; ++found) {
    const std::cmatch& part = *found;
    const ShownUnit& unit = *shown_units().of(part.str(3));
    std::vector<std::string> amounts = {part.str(2)};
    if (part[4].matched) amounts.insert(amounts.end(), {part.str(5), part.str(7)});
    amounts = converted(amounts, unit);
    text += part.prefix().str() + part.str(1) + amounts[0] + " ";
    text += spelling == Spelling::page ? unit.name : unit.ascii;
    if (part[4].matched) text += part.str(4) + amounts[1] + part.str(6) + amounts[2];
    rest = words.begin() + (part[0].second - words.data());
  }
  return text + std::string(rest, words.end());
}

ShowIn::ShowIn(UnitSystem system) : before_(today) {
  today = system;
}

ShowIn::~ShowIn() {
  today = before_;
}

}  // namespace fingertip::studies::inline files
