#include "studies/cases/force_errors.h"

#include <algorithm>
#include <cmath>

#include "studies/report/run_data.h"

namespace fingertip::studies {

using meshes::PressResponse;
using reporting::force_at;

std::vector<double> verdict_depths(double depth) {
  return {depth / 6.0, depth / 3.0, depth / 2.0, depth * 2.0 / 3.0, depth};
}

nlohmann::ordered_json force_errors(const PressResponse& response, const PressResponse& reference,
                                    double depth) {
  nlohmann::ordered_json errors = nlohmann::ordered_json::array();
  for (const double at : verdict_depths(depth)) {
    const double error = force_at(response, at) / force_at(reference, at) - 1.0;
    errors.push_back(std::isfinite(error) ? nlohmann::ordered_json(error)
                                          : nlohmann::ordered_json());
  }
  return errors;
}

double estimated_force_error(const PressResponse& continuum, double depth) {
  const auto nearest = std::ranges::min_element(
      continuum.samples(), {},
      [&](const meshes::PressSample& sample) { return std::abs(sample.indentation - depth); });
  return nearest->force_error / nearest->normal_force;
}

}  // namespace fingertip::studies
