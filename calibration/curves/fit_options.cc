#include "calibration/curves/fit_options.h"

namespace fingertip::calibration {

std::string label(const FreeParameter& free) {
  return std::string(name(free.parameter)) + (free.of.empty() ? "" : " (" + free.of + ")");
}

std::vector<MaterialParameter> parameters_in(const CurveFitOptions& options) {
  std::vector<MaterialParameter> parameters;
  for (const FreeParameter& free : options.free) parameters.push_back(free.parameter);
  return parameters;
}

}  // namespace fingertip::calibration
