#include "studies/report/figure/axis_tics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/report/figure/format.h"

namespace fingertip::studies::report::inline figure {
namespace {

/// Powers of ten that enclose a positive extent, with 2 and 5 times them where `finely`.
std::vector<double> decades(const Range& extent, bool finely) {
  const int first = int(std::floor(std::log10(extent.from)));
  const int last = int(std::ceil(std::log10(extent.to)));
  const int step = last - first > 8 ? 2 : 1;
  std::vector<double> tics;
  for (int exponent = first; exponent <= last; exponent += step)
    for (const int mantissa : {1, 2, 5})
      if (mantissa == 1 || finely) tics.push_back(mantissa * std::pow(10.0, exponent));
  return tics;
}

/// Multiples of 1, 2 or 5 times a power of ten, three to eight within a range.
std::vector<double> multiples(const Range& range) {
  constexpr double max_tics = 8.0;
  const double finest = (range.to - range.from) / max_tics;
  double step = std::pow(10.0, std::floor(std::log10(finest)));
  for (const double factor : {2.0, 2.5, 2.0})  // 1, 2, 5, 10
    if (step < finest) step *= factor;
  std::vector<double> tics;
  for (double n = std::ceil(range.from / step); n * step <= range.to; ++n) tics.push_back(n * step);
  return tics;
}

}  // namespace

std::vector<double> logarithmic_tics(const Range& extent, const Range& range) {
  constexpr int min_tics = 3;
  constexpr std::size_t max_decades = 3;  // with 2 and 5 times them
  const auto too_few = [&](const std::vector<double>& tics) {
    return std::ranges::count_if(
               tics, [&](double tic) { return range.from <= tic && tic <= range.to; }) < min_tics;
  };
  std::vector<double> tics = decades(extent, false);
  if (tics.size() <= max_decades || too_few(tics)) tics = decades(extent, true);
  return too_few(tics) && range.from < range.to ? multiples(range) : tics;
}

std::string tic_label(double value) {
  const int exponent = int(std::floor(std::log10(value) + 1e-9));
  if (std::abs(exponent) <= 3) return fmt::format("{:.4g}", value);
  const std::string mantissa = fmt::format("{:.4g}", value / std::pow(10.0, exponent));
  return mantissa == "1" ? power_of_ten(exponent) : mantissa + "×" + power_of_ten(exponent);
}

}  // namespace fingertip::studies::report::inline figure
