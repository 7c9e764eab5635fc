#include "studies/fits/runs/fit_bias.h"

#include <fmt/format.h>

#include <cmath>

#include "calibration/files/words.h"
#include "meshes/tables/interpolation.h"
#include "studies/jobs/json_file.h"

namespace fingertip::studies::inline fits::inline runs {

using Eigen::Index;
using nlohmann::ordered_json;

namespace {

std::string statement(const ordered_json& parameters) {
  std::string text =
      " The lattice's own error, measured by the continuum at the estimates, shifts them; with that"
      " the 95 % intervals are";
  for (const ordered_json& parameter : parameters) {
    const std::string unit = parameter["unit"];
    text += fmt::format("{} {} {} to {} (shifted by {:+.2g} %)",
                        &parameter == &parameters.front() ? "" : ",",
                        parameter["name"].get<std::string>(),
                        calibration::quantity_text(number_of(parameter["lower"]), unit),
                        calibration::quantity_text(number_of(parameter["upper"]), unit),
                        100.0 * number_of(parameter["bias"]) / number_of(parameter["estimate"]));
  }
  return text + ".";
}

}  // namespace

Eigen::VectorXd lattice_error(const calibration::Curve& curve, const std::vector<double>& residuals,
                              const meshes::PressResponse& continuum) {
  std::vector<double> fitted = curve.y;
  for (std::size_t i = 0; i < fitted.size(); ++i) fitted[i] -= residuals[i];
  std::vector<double> depths, relative;
  for (const meshes::PressSample& sample : continuum.samples()) {
    depths.push_back(sample.indentation);
    relative.push_back(1.0 - sample.normal_force /
                                 meshes::interpolated(curve.x, fitted, sample.indentation));
  }
  Eigen::VectorXd error(Index(fitted.size()));
  for (std::size_t i = 0; i < fitted.size(); ++i)
    error(Index(i)) = fitted[i] * meshes::interpolated(depths, relative, curve.x[i]);
  return error;
}

void add_bias(const Eigen::VectorXd& error, ordered_json& calibration) {
  ordered_json& parameters = calibration["parameters"];
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const auto row = calibration["influence"][p].get<std::vector<double>>();
    const double bias = -Eigen::Map<const Eigen::VectorXd>(row.data(), error.size()).dot(error);
    ordered_json& parameter = parameters[p];
    parameter["bias"] = bias;
    parameter["lower"] = number_or_null(number_of(parameter["lower"]) - std::abs(bias));
    parameter["upper"] = number_or_null(number_of(parameter["upper"]) + std::abs(bias));
  }
  calibration["statement"] = calibration["statement"].get<std::string>() + statement(parameters);
}

}  // namespace fingertip::studies::inline fits::inline runs
