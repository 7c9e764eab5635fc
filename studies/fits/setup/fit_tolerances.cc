#include "studies/fits/setup/fit_tolerances.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "studies/fits/models/described_numbers.h"

namespace fingertip::studies::inline fits::inline setup {

using calibration::Described;

namespace {

/// Of soft rubber whose Poisson's ratio nobody tells.
constexpr double lowest_untold = 0.45, highest_untold = 0.4999;

void check(const LoadedConfig& loaded, const FitInput& input) {
  for (const auto& [what, deviation] : loaded.config.calibration.tolerances) {
    const std::string field(calibration::name(what));
    if (!(deviation > 0.0))
      throw refused(loaded, "calibration.tolerances", field, "a tolerance is one positive quantity",
                    "give the standard deviation of " + field + " alone");
    if (!any_has(input, what))
      throw refused(loaded, "calibration.tolerances", field, "no press of the fit has this number",
                    "leave it out; of profiles and solids give scale");
  }
}

/// Whether somebody tells Poisson's ratio.
bool ratio_is_told(const LoadedConfig& loaded) {
  const auto given = [&](const char* key) { return loaded.entries.at(key).given; };
  const bool stiffness = given("rubber.youngs_modulus") || given("rubber.shore_hardness");
  return given("rubber.poissons_ratio") || given("rubber.card") || given("lattice.constants") ||
         int(stiffness) + int(given("rubber.shear_modulus")) + int(given("rubber.bulk_modulus")) >
             1;
}

/// Of Poisson's ratio where it is held and not known.
std::optional<KnownError> of_ratio(const LoadedConfig& loaded, const FitInput& input) {
  const bool held = frees(input, calibration::MaterialParameter::modulus);
  const bool ranges = loaded.entries.at("calibration.poisson_range").given;
  if (!held || (ratio_is_told(loaded) && !ranges)) return std::nullopt;
  KnownError error{.name = "", .number = Described::poissons_ratio};
  const std::vector<double>& range = loaded.config.calibration.poisson_range;
  error.low = ranges ? range[0] : std::min(input.base.rubber.poissons_ratio(), lowest_untold);
  error.high = ranges ? range[1] : highest_untold;
  error.step = (error.high - error.low) / std::sqrt(12.0);
  return error;
}

}  // namespace

void add_tolerances(const LoadedConfig& loaded, FitInput& input) {
  if (input.problem != CalibrationProblem::experiment || !has_presses(input)) return;
  check(loaded, input);
  std::vector<KnownError> numbers;
  for (const auto& [what, deviation] : loaded.config.calibration.tolerances)
    numbers.push_back({.name = "", .number = what, .step = deviation});
  if (const auto ratio = of_ratio(loaded, input)) numbers.push_back(*ratio);
  for (const KnownError& number : numbers)
    for (const KnownError& each : by_value(number, input)) {
      for (FitCurve& curve : input.curves)
        curve.known_errors.push_back(changes_of(each, curve.press));
      input.known_errors.push_back(each);
    }
}

std::vector<std::vector<double>> known_errors_of(const FitInput& input,
                                                 const lattice::PressSetup& press) {
  std::vector<std::vector<double>> errors;
  const FitCurve& first = input.curves.front();
  for (std::size_t k = 0; k < input.known_errors.size(); ++k) {
    const KnownError& error = input.known_errors[k];
    if (error.number)
      errors.push_back(changes_of(error, press));
    else
      errors.emplace_back(press.protocol.samples.size(), first.known_errors[k].back());
  }
  return errors;
}

}  // namespace fingertip::studies::inline fits::inline setup
