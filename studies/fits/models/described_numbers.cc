#include "studies/fits/models/described_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fingertip::studies::inline fits::inline models {

using calibration::Described;
using lattice::PressSetup;

namespace {

constexpr double untold_step = 0.01;
/// No number is steeper there.
constexpr double highest_ratio = 0.4999;

/// Values between which the forces are compared, and what of the difference is one step.
struct Ends {
  double low = 0.0, high = 0.0, share = 1.0;
};

Ends ends_of(const KnownError& error) {
  const double value = error.value, step = error.step;
  if (error.low < error.high) return {error.low, error.high, step / (error.high - error.low)};
  // To the other side a press about the axis is its own mirror image.
  const bool about_axis =
      (error.number == Described::tilt || error.number == Described::obstacle_offset) &&
      std::abs(value) < step;
  Ends ends{about_axis ? value : value - step, value + step};
  if (error.number == Described::poissons_ratio) ends.high = std::min(ends.high, highest_ratio);
  ends.share = step / (ends.high - ends.low);
  return ends;
}

bool is_same(double a, double b) {
  return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b));
}

}  // namespace

bool any_has(const FitInput& input, Described number) {
  return std::ranges::any_of(
      input.curves, [&](const FitCurve& curve) { return calibration::has(curve.press, number); });
}

bool has_value(const PressSetup& press, Described number, double value) {
  return calibration::has(press, number) && is_same(calibration::value_of(press, number), value);
}

std::vector<KnownError> by_value(const KnownError& error, const FitInput& input) {
  std::vector<KnownError> found;
  for (const FitCurve& curve : input.curves) {
    if (!calibration::has(curve.press, *error.number)) continue;
    const double value = calibration::value_of(curve.press, *error.number);
    if (std::ranges::any_of(found,
                            [&](const KnownError& other) { return is_same(value, other.value); }))
      continue;
    found.push_back(error);
    found.back().value = value;
  }
  for (KnownError& each : found) {
    each.name = calibration::name(*each.number);
    if (found.size() > 1) each.name += fmt::format(" of {:.4g}", each.value);
  }
  return found;
}

std::vector<double> changes_of(const KnownError& error, const PressSetup& press) {
  if (!has_value(press, *error.number, error.value)) return {};
  const Ends ends = ends_of(error);
  const Eigen::VectorXd change =
      ends.share * calibration::change_between(press, *error.number, ends.low, ends.high);
  return {change.begin(), change.end()};
}

std::vector<KnownError> untold_numbers(const FitInput& input) {
  std::vector<KnownError> untold;
  using enum Described;
  for (const Described number : {tip_radius, rod_radius, scale, obstacle_radius, poissons_ratio}) {
    if (std::ranges::find(input.known_errors, number, &KnownError::number) !=
            input.known_errors.end() ||
        (number == scale && input.base.geometry.is_dome()))
      continue;
    if (number == poissons_ratio && !frees(input, calibration::MaterialParameter::modulus))
      continue;
    for (KnownError& each : by_value({.name = "", .number = number}, input)) {
      each.step = untold_step * (number == poissons_ratio ? 1.0 : each.value);
      untold.push_back(std::move(each));
    }
  }
  return untold;
}

}  // namespace fingertip::studies::inline fits::inline models
