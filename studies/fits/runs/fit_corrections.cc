#include "studies/fits/runs/fit_corrections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibration/files/words.h"
#include "calibration/press_fit/fit_record.h"
#include "meshes/tables/interpolation.h"
#include "studies/fits/setup/configured_fit.h"

namespace fingertip::studies::inline fits::inline runs {

using calibration::FitFile;
using Eigen::Index;
using meshes::ContactMode;

namespace {

std::string bias_words(const std::vector<calibration::ParameterEntry>& parameters) {
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

void add_bias(const Eigen::VectorXd& error, FitFile& fit) {
  for (std::size_t p = 0; p < fit.parameters.size(); ++p) {
    calibration::ParameterEntry& parameter = fit.parameters[p];
    parameter.bias = -Eigen::VectorXd::Map(fit.influence[p].data(), error.size()).dot(error);
    parameter.lower -= std::abs(parameter.bias);
    parameter.upper += std::abs(parameter.bias);
  }
  fit.statement += bias_words(fit.parameters);
}

namespace {

ContactMode opposite(ContactMode contact) {
  return contact == ContactMode::stick ? ContactMode::frictionless : ContactMode::stick;
}

std::string contact_words(const FitFile& other, const std::string& taken, const std::string& name,
                          const FitFile& fit) {
  std::string text = fmt::format(
      " Whether the rubber sticks is not told (press.contact): {} is taken. With {} contact", taken,
      name);
  for (const calibration::ParameterEntry& each : other.parameters)
    text += fmt::format(
        "{} {} = {} (95 %: {:.5g} to {:.5g})", &each == &other.parameters.front() ? "" : ";",
        each.name, calibration::quantity_text(each.estimate, each.unit), each.lower, each.upper);
  if (std::isfinite(fit.chi_square) && std::isfinite(other.chi_square))
    text += fmt::format(", chi-square {:.4g} in place of {:.4g}", other.chi_square, fit.chi_square);
  else
    text += fmt::format(", residuals of {:.3g} N in place of {:.3g} N", other.residual_deviation,
                        fit.residual_deviation);
  return text + ". The intervals that are told cover both.";
}

/// What is foretold of a press with either contact.
void take_either(const calibration::PredictedEntry& other, const std::string& name,
                 calibration::PredictedEntry& own, std::string& statement) {
  statement += fmt::format(" With {} contact: {}", name, calibration::prediction_words(other));
  if (!other.failure.empty() || !own.failure.empty()) return;
  own.within = 0.0;
  for (std::size_t i = 0; i < own.x.size(); ++i) {
    own.lower[i] = std::min(own.lower[i], other.lower[i]);
    own.upper[i] = std::max(own.upper[i], other.upper[i]);
    own.within += own.measured[i] >= own.lower[i] && own.measured[i] <= own.upper[i]
                      ? 1.0 / double(own.x.size())
                      : 0.0;
  }
  own.probability = std::max(own.probability, other.probability);
}

}  // namespace

std::string contact_name(const FitSetup& fit) {
  return std::string(meshes::name(fit.loaded.config.press.protocol.contact));
}

std::optional<FitSetup> with_other_contact(const FitSetup& fit) {
  const CalibrationSettings& settings = fit.loaded.config.calibration;
  if (settings.problem != CalibrationProblem::experiment || settings.contact_as_given ||
      fit.contact_known || !has_presses(fit.input))
    return std::nullopt;
  const ContactMode other = opposite(fit.loaded.config.press.protocol.contact);
  FitSetup rival =
      fit_setup(with_sets(fit.loaded, {"press.contact=" + std::string(meshes::name(other)),
                                       "calibration.candidates=[]", "calibration.profile=[]"}),
                fit.files);
  // Both run side by side: in one folder a fit would read the other contact's forces.
  rival.input.place = "other_contact_" + rival.input.place;
  rival.input.contact_told = false;  // by nobody: it is chosen afterwards
  return rival;
}

void add_other_contact(const FitFile& other, const std::string& taken, const std::string& name,
                       FitFile& fit) {
  const std::string said = contact_words(other, taken, name, fit);
  fit.contact = {taken, name, other.chi_square, other.residual_deviation, {}};
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    const calibration::ParameterEntry& rival = other.parameters[i];
    calibration::ParameterEntry& own = fit.parameters[i];
    fit.contact->parameters.push_back({rival.name, rival.estimate, rival.lower, rival.upper});
    own.lower = std::min(own.lower, rival.lower);  // NaN, no interval at all, stays
    own.upper = std::max(own.upper, rival.upper);
    own.interval += ", both contacts";
  }
  fit.statement += said;
  for (std::size_t i = 0; i < fit.predicted.size(); ++i)
    take_either(other.predicted[i], name, fit.predicted[i], fit.statement);
}

void refuse_what_is_open(FitFile& fit) {
  if (!fit.failed.empty()) return;
  for (const calibration::ParameterEntry& each : fit.parameters) {
    if (each.unit != "Pa" ||
        !calibration::is_open(each.unit, each.estimate, each.lower, each.upper))
      continue;
    const std::string sentence = fmt::format(
        "{} is not determined by these data: its 95 % interval is {:.4g} to {:.4g} Pa{}", each.name,
        each.lower, each.upper, fit.contact ? "; tell the contact (press.contact)" : "");
    fit.failed.push_back(sentence);
    fit.statement = "Not accepted: " + sentence + ". " + fit.statement;
  }
}

}  // namespace fingertip::studies::inline fits::inline runs
