#include "studies/fits/runs/fit_contact.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibration/files/words.h"
#include "studies/fits/setup/configured_fit.h"

namespace fingertip::studies::inline fits::inline runs {

using calibration::FitFile;
using meshes::ContactMode;

namespace {

ContactMode opposite(ContactMode contact) {
  return contact == ContactMode::stick ? ContactMode::frictionless : ContactMode::stick;
}

std::string statement(const FitFile& other, const std::string& taken, const std::string& name,
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
  return fit_setup(with_sets(fit.loaded, {"press.contact=" + std::string(meshes::name(other)),
                                          "calibration.candidates=[]", "calibration.profile=[]"}));
}

void add_other_contact(const FitFile& other, const std::string& taken, const std::string& name,
                       FitFile& fit) {
  const std::string said = statement(other, taken, name, fit);
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
}

}  // namespace fingertip::studies::inline fits::inline runs
