#include "studies/config/text/units.h"

#include <udunits2.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>

#include "studies/config/text/trimmed.h"
#include "studies/files/places.h"

namespace fingertip::studies::inline config::inline text {

namespace {

struct FreeUnit {
  void operator()(ut_unit* unit) const { ut_free(unit); }
};
using Unit = std::unique_ptr<ut_unit, FreeUnit>;

/// The unit system: UDUNITS' own data base plus what mechanics people write and it does not know.
/// Read once on first use (5 ms), never changed afterwards.
const ut_system& units() {
  static const std::unique_ptr<ut_system, decltype(&ut_free_system)> system = [] {
    ut_set_error_message_handler(ut_ignore);
    const std::filesystem::path own = data_folder("udunits", {}) / "udunits2.xml";
    std::unique_ptr<ut_system, decltype(&ut_free_system)> read(
        ut_read_xml(std::filesystem::exists(own) ? own.c_str() : nullptr), &ut_free_system);
    if (!read) throw std::runtime_error("cannot read the UDUNITS-2 unit data base");
    const Unit degree(ut_parse(read.get(), "degree", UT_ASCII));
    ut_map_symbol_to_unit("deg", UT_ASCII, degree.get());
    return read;
  }();
  return *system;
}

/// UDUNITS' parser has one state for all threads.
std::recursive_mutex& parser() {
  static std::recursive_mutex mutex;
  return mutex;
}

Unit parse_unit(const std::string& text) {
  const std::lock_guard lock(parser());
  return Unit(ut_parse(&units(), text.c_str(), UT_UTF8));
}

/// Whether the two differ by an angle. UDUNITS counts the radian as a mere number, so that 5 %
/// would pass for an angle and 377 rad/s for 377 Hz.
bool differ_by_an_angle(const ut_unit* a, const ut_unit* b) {
  const Unit quotient(ut_divide(a, b));
  std::array<char, 128> text{};
  ut_format(quotient.get(), text.data(), text.size(), UT_ASCII);
  return std::string_view(text.data()).find("rad") != std::string_view::npos;
}

/// The factor between two units; empty when they differ in dimension.
std::optional<double> factor(const std::string& from, const std::string& to) {
  const std::lock_guard lock(parser());
  const Unit source = parse_unit(from);
  const Unit target = parse_unit(to);
  if (!source || !target || !ut_are_convertible(source.get(), target.get())) return {};
  if (differ_by_an_angle(source.get(), target.get())) return {};
  const std::unique_ptr<cv_converter, decltype(&cv_free)> converter(
      ut_get_converter(source.get(), target.get()), &cv_free);
  if (!converter) return {};
  // UDUNITS calls 1/s and s convertible, and degC and K: only a pure factor will do here.
  const double image_of_one = cv_convert_double(converter.get(), 1.0);
  const double image_of_two = cv_convert_double(converter.get(), 2.0);
  if (!(std::abs(image_of_two - 2.0 * image_of_one) <= 1e-12 * std::abs(image_of_one))) return {};
  return image_of_one;
}

/// The value to 15 digits: products of decimal factors leave round-off in the 16th, and the same
/// quantity in two units shall be the same number (and find the same cached result).
double without_round_off(double value) {
  std::array<char, 32> text{};
  const auto written = std::to_chars(text.data(), text.data() + text.size(), value,
                                     std::chars_format::scientific, 14);
  std::from_chars(text.data(), written.ptr, value);
  return value;
}

}  // namespace

double parse_quantity(std::string_view text, const std::string& unit, const std::string& example) {
  const std::string advice = "write it as \"" + example + "\"";
  text = trimmed(text);
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double number = 0.0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc::result_out_of_range) {
    throw UnitError("the number is too large or too small", advice);
  }
  if (error != std::errc()) {
    throw UnitError("must be a number with a unit of the dimension of " + unit, advice);
  }
  if (!std::isfinite(number)) throw UnitError("must be a finite number", advice);
  const std::string_view unit_text =
      trimmed(text.substr(static_cast<std::size_t>(rest - text.data())));
  if (unit_text.empty()) throw UnitError("the unit is missing", advice);
  // A second number ("1 2 cm") would be taken by UDUNITS as a factor of the unit.
  const std::string given(unit_text);
  const bool second_number =
      unit_text.find_first_of("0123456789.+-(") == 0 && !unit_text.starts_with("1/");
  // UDUNITS prints characters of which it knows nothing.
  const bool control =
      std::ranges::any_of(given, [](char c) { return (c >= '\0' && c < ' ') || c == 0x7f; });
  if (second_number || control || !parse_unit(given)) {
    throw UnitError("\"" + given + "\" is not a unit", advice);
  }
  const std::optional<double> scale = factor(given, unit);
  if (!scale) {
    throw UnitError("\"" + given + "\" has the wrong dimension, a unit like " + unit + " is needed",
                    advice);
  }
  const double value = number * *scale;
  if (!std::isfinite(value)) throw UnitError("must be a finite number", advice);
  return without_round_off(value);
}

double convert(double value, const std::string& from, const std::string& to) {
  const std::optional<double> scale = factor(from, to);
  if (!scale) throw UnitError("cannot convert " + from + " to " + to, "use another unit");
  return value * *scale;
}

}  // namespace fingertip::studies::inline config::inline text
