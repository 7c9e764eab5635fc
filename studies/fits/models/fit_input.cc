#include "studies/fits/models/fit_input.h"

namespace fingertip::studies::inline fits::inline models {

using calibration::MaterialParameter;

bool by_continuum(const FitInput& input) {
  return !input.kinds.empty() && input.kinds.front() == CurveKind::continuum;
}

std::vector<MaterialParameter> parameters_of(const FitInput& input) {
  std::vector<MaterialParameter> parameters;
  for (const auto& free : input.options.free)
    if (!calibration::is_behind_the_press(free.parameter)) parameters.push_back(free.parameter);
  return parameters;
}

bool asks_one_press(const FitInput& input) {
  return parameters_of(input) == std::vector{MaterialParameter::modulus};
}

}  // namespace fingertip::studies::inline fits::inline models
