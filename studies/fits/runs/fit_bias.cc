#include "studies/fits/runs/fit_bias.h"

#include <fmt/format.h>

#include <cmath>

#include "calibration/files/words.h"
#include "meshes/tables/interpolation.h"

namespace fingertip::studies::inline fits::inline runs {

using Eigen::Index;

namespace {

std::string statement(const std::vector<calibration::ParameterEntry>& parameters) {
  std::string text =
      " The lattice's own error, measured by the continuum at the estimates, shifts them; with that"
      " the 95 % intervals are";
  for (const calibration::ParameterEntry& each : parameters)
    text += fmt::format(
        "{} {} {} to {} (shifted by {:+.2g} %)", &each == &parameters.front() ? "" : ",", each.name,
        calibration::quantity_text(each.lower, each.unit),
        calibration::quantity_text(each.upper, each.unit), 100.0 * each.bias / each.estimate);
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

void add_bias(const Eigen::VectorXd& error, calibration::FitFile& fit) {
  for (std::size_t p = 0; p < fit.parameters.size(); ++p) {
    calibration::ParameterEntry& parameter = fit.parameters[p];
    parameter.bias = -Eigen::VectorXd::Map(fit.influence[p].data(), error.size()).dot(error);
    parameter.lower -= std::abs(parameter.bias);
    parameter.upper += std::abs(parameter.bias);
  }
  fit.statement += statement(fit.parameters);
}

}  // namespace fingertip::studies::inline fits::inline runs
