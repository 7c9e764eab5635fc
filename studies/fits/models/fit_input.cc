#include "studies/fits/models/fit_input.h"

#include <algorithm>

namespace fingertip::studies::inline fits::inline models {

using calibration::MaterialParameter;

bool by_continuum(const FitInput& input) {
  return !input.curves.empty() && input.curves.front().kind == CurveKind::continuum;
}

bool is_press(CurveKind kind) {
  using enum CurveKind;
  return kind == press || kind == continuum || kind == ramp || kind == moving_press;
}

bool has_presses(const FitInput& input) {
  return !input.curves.empty() && is_press(input.curves.front().kind);
}

bool has_travels(const FitInput& input) {
  return !input.curves.empty() && input.curves.front().travel;
}

std::vector<calibration::Curve> curves_of(const FitInput& input) {
  return {input.curves.begin(), input.curves.end()};
}

std::vector<MaterialParameter> parameters_of(const FitInput& input) {
  std::vector<MaterialParameter> parameters;
  for (const auto& free : input.options.free)
    if (!calibration::is_behind_the_press(free.parameter)) parameters.push_back(free.parameter);
  return parameters;
}

bool frees(const FitInput& input, calibration::MaterialParameter parameter) {
  return std::ranges::find(input.options.free, parameter, &calibration::FreeParameter::parameter) !=
         input.options.free.end();
}

bool seeks_moduli_alone(const FitInput& input) {
  return std::ranges::all_of(parameters_of(input), calibration::is_of_the_rubber);
}

bool asks_one_press(const FitInput& input) {
  return parameters_of(input) == std::vector{MaterialParameter::modulus};
}

}  // namespace fingertip::studies::inline fits::inline models
