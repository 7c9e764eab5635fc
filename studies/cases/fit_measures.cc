#include "studies/cases/fit_measures.h"

#include <algorithm>
#include <cmath>

#include "studies/config/config.h"
#include "studies/run/json_file.h"

namespace fingertip::studies {

namespace {

using nlohmann::ordered_json;

/// What a fit's parameter should be: the case's own rubber.
double truth(const Case& one, const std::string& parameter) {
  const meshes::Rubber& rubber = one.loaded.config.press.rubber;
  if (parameter == "youngs_modulus") return rubber.youngs_modulus;
  if (parameter == "shear_modulus" || parameter == "lame_shear") return rubber.shear_modulus;
  if (parameter == "lambda") return rubber.lame_lambda();
  if (parameter == "retardation_time") return rubber.retardation_time;
  return std::nan("");
}

const std::vector<std::string>& known_parameters() {
  static const std::vector<std::string> names = {"youngs_modulus", "shear_modulus", "lame_shear",
                                                 "lambda", "retardation_time"};
  return names;
}

/// 0 inside the interval, else how far outside, over the truth.
double outside(const ordered_json& parameter, double value) {
  const double below = number_of(parameter["lower"]) - value;
  const double above = value - number_of(parameter["upper"]);
  return std::max({below, above, 0.0}) / std::abs(value);
}

void add_parameters(const Case& one, const std::string& fit, const ordered_json& calibration,
                    std::map<std::string, double>& measures) {
  for (const ordered_json& parameter : calibration.value("parameters", ordered_json::array())) {
    const std::string name = parameter["name"];
    const double value = truth(one, name);
    if (!std::isfinite(value) || parameter["estimate"].is_null()) continue;
    measures[fit + "." + name + "_error"] =
        std::abs(parameter["estimate"].get<double>() / value - 1.0);
    measures[fit + "." + name + "_outside"] = outside(parameter, value);
  }
}

}  // namespace

std::vector<std::string> fit_measure_names(const Case& one) {
  std::vector<std::string> names = {"transfer.worst_error"};
  for (const CaseVariant& fit : one.fits) {
    names.push_back(fit.name + ".worst_error");
    names.push_back(fit.name + ".open_directions");
    names.push_back(fit.name + ".claims_certainty");
    for (const CaseVariant& prediction : one.predictions)
      if (is_asked(prediction, fit)) names.push_back(fit.name + "." + prediction.name);
    for (const std::string& parameter : known_parameters())
      for (const char* what : {"_error", "_outside"})
        names.push_back(fit.name + "." + parameter + what);
  }
  return names;
}

std::map<std::string, double> take_fit_measures(const Case& one, const TransferErrors& errors,
                                                const std::vector<ordered_json>& calibrations) {
  std::map<std::string, double> measures;
  double worst = one.predictions.empty() ? std::nan("") : 0.0;
  for (std::size_t f = 0; f < one.fits.size(); ++f) {
    const std::string& fit = one.fits[f].name;
    double worst_of_fit = worst * 0.0;
    for (std::size_t p = 0; p < one.predictions.size(); ++p) {
      if (!is_asked(one.predictions[p], one.fits[f])) continue;
      const double error = errors[f][p];
      if (std::isfinite(error)) measures[fit + "." + one.predictions[p].name] = error;
      // A gap is no small error.
      worst_of_fit = std::isnan(error) ? error : std::max(worst_of_fit, error);
    }
    if (std::isfinite(worst_of_fit)) measures[fit + ".worst_error"] = worst_of_fit;
    worst = std::isnan(worst_of_fit) ? worst_of_fit : std::max(worst, worst_of_fit);
    const ordered_json& calibration = calibrations[f];
    const double open = double(calibration.value("unidentifiable", ordered_json::array()).size());
    measures[fit + ".open_directions"] = open;
    measures[fit + ".claims_certainty"] = open > 0.0 ? 0.0 : 1.0;
    // Estimates of a search that did not end are none.
    if (calibration.value("converged", true)) add_parameters(one, fit, calibration, measures);
  }
  if (std::isfinite(worst)) measures["transfer.worst_error"] = worst;
  return measures;
}

}  // namespace fingertip::studies
