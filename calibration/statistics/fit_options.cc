#include "calibration/statistics/fit_options.h"

namespace fingertip::calibration::inline statistics {

std::string label(const FreeParameter& free) {
  return std::string(name(free.parameter)) + (free.of.empty() ? "" : " (" + free.of + ")");
}

Eigen::VectorXd start_of(const CurveFitOptions& options) {
  Eigen::VectorXd start(Eigen::Index(options.free.size()));
  for (Eigen::Index i = 0; i < start.size(); ++i) start(i) = options.free[std::size_t(i)].start;
  return start;
}

std::vector<MaterialParameter> parameters_in(const CurveFitOptions& options) {
  std::vector<MaterialParameter> parameters;
  for (const FreeParameter& free : options.free) parameters.push_back(free.parameter);
  return parameters;
}

}  // namespace fingertip::calibration::inline statistics
