/// A contact that nobody told: the fit with the other one beside that with the default.
#pragma once

#include <optional>
#include <string>

#include "calibration/files/fit_file.h"
#include "studies/fits/setup/fit_setup.h"

namespace fingertip::studies::inline fits::inline runs {

/// The setup of `fit` with the other contact, sticking or frictionless, wherever none is given;
/// none where all presses of an experiment say theirs, or calibration.contact is "given". It weighs
/// no further measurements. Throws ConfigError as fit_setup does.
std::optional<FitSetup> with_other_contact(const FitSetup& fit);

/// "stick" or "frictionless": what presses are done with that do not say it.
std::string contact_name(const FitSetup& fit);

/// Adds `other`, the fit with the other contact, to `fit`: the entry contact, 95 % intervals that
/// cover both, and words on the difference.
void add_other_contact(const calibration::FitFile& other, const std::string& taken,
                       const std::string& name, calibration::FitFile& fit);

}  // namespace fingertip::studies::inline fits::inline runs
