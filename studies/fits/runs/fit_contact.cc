#include "studies/fits/runs/fit_contact.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibration/files/fit_file.h"
#include "calibration/files/words.h"
#include "meshes/tables/fields_json.h"
#include "studies/fits/setup/configured_fit.h"
#include "studies/jobs/json_file.h"

namespace fingertip::studies::inline fits::inline runs {

using calibration::quantity_text;
using meshes::ContactMode;
using nlohmann::ordered_json;

namespace {

ContactMode opposite(ContactMode contact) {
  return contact == ContactMode::stick ? ContactMode::frictionless : ContactMode::stick;
}

std::string estimate_words(const ordered_json& parameter) {
  return fmt::format(
      "{} = {} (95 %: {:.5g} to {:.5g})", parameter["name"].get<std::string>(),
      quantity_text(number_of(parameter["estimate"]), parameter["unit"].get<std::string>()),
      number_of(parameter["lower"]), number_of(parameter["upper"]));
}

std::string statement(const ordered_json& other, const std::string& taken, const std::string& name,
                      const ordered_json& calibration) {
  std::string text = fmt::format(
      " Whether the rubber sticks is not told (press.contact): {} is taken. With {} contact", taken,
      name);
  for (std::size_t i = 0; i < other["parameters"].size(); ++i)
    text += (i == 0 ? " " : "; ") + estimate_words(other["parameters"][i]);
  const double own = number_of(calibration["chi_square"]), rival = number_of(other["chi_square"]);
  if (std::isfinite(own) && std::isfinite(rival))
    text += fmt::format(", chi-square {:.4g} in place of {:.4g}", rival, own);
  else
    text += fmt::format(", residuals of {:.3g} N in place of {:.3g} N",
                        number_of(other["residual_deviation"]),
                        number_of(calibration["residual_deviation"]));
  return text + ". The intervals that are told cover both.";
}

}  // namespace

std::string contact_name(const FitSetup& fit) {
  return std::string(meshes::name(fit.loaded.config.press.protocol.contact));
}

std::optional<FitSetup> with_other_contact(const FitSetup& fit) {
  const CalibrationSettings& settings = fit.loaded.config.calibration;
  if (settings.problem != CalibrationProblem::experiment || settings.contact_as_given ||
      fit.contact_known || fit.input.presses.empty())
    return std::nullopt;
  const ContactMode other = opposite(fit.loaded.config.press.protocol.contact);
  return fit_setup(with_sets(fit.loaded, {"press.contact=" + std::string(meshes::name(other)),
                                          "calibration.candidates=[]", "calibration.profile=[]"}));
}

void add_other_contact(const ordered_json& other, const std::string& taken, const std::string& name,
                       ordered_json& calibration) {
  calibration::ContactEntry entry{
      taken, name, number_of(other["chi_square"]), number_of(other["residual_deviation"]), {}};
  const std::string said = statement(other, taken, name, calibration);
  ordered_json& parameters = calibration["parameters"];
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const ordered_json& own = other["parameters"][i];
    const double lower = number_of(own["lower"]), upper = number_of(own["upper"]);
    entry.parameters.push_back(
        {own["name"].get<std::string>(), number_of(own["estimate"]), lower, upper});
    ordered_json& parameter = parameters[i];
    // NaN, no interval at all, stays.
    parameter["lower"] = number_or_null(std::min(number_of(parameter["lower"]), lower));
    parameter["upper"] = number_or_null(std::max(number_of(parameter["upper"]), upper));
    parameter["interval"] = parameter["interval"].get<std::string>() + ", both contacts";
  }
  calibration["contact"] = meshes::json_of(entry);
  calibration["statement"] = calibration["statement"].get<std::string>() + said;
}

}  // namespace fingertip::studies::inline fits::inline runs
