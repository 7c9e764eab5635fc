/// What is added to a fit that is done: what the error of its lattice does to its parameters, and
/// the fit with the other contact where nobody told it.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "calibration/files/fit_file.h"
#include "calibration/statistics/curve.h"
#include "meshes/press/press_response.h"
#include "studies/fits/setup/fit_setup.h"

namespace fingertip::studies::inline fits::inline runs {

/// The lattice's force at the estimates, minus the continuum's at the same E and G, at every x of
/// a curve [N]. `residuals` are measured minus the lattice's. Between the continuum's few samples
/// the relative error is taken as linear, beyond them as constant.
Eigen::VectorXd lattice_error(const calibration::Curve& curve, const std::vector<double>& residuals,
                              const meshes::PressResponse& continuum);

/// Adds to a fit every parameter's bias: -influence times `error` (of all curves, one below the
/// other). Intervals widen by its magnitude to both sides, and the statement says so.
void add_bias(const Eigen::VectorXd& error, calibration::FitFile& fit);

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

/// Refuses, in a fit that passed its own tests, a modulus whose interval exceeds it (is_open) once
/// all that widens it has.
void refuse_what_is_open(calibration::FitFile& fit);

}  // namespace fingertip::studies::inline fits::inline runs
