/// The curves of a fit and what answers for each.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "studies/fits/setup/fit_setup.h"
#include "studies/presses/press_setup.h"

namespace fingertip::studies::inline fits::inline setup {

/// "press.contact = stick; press.tilt=20 deg" as --set texts.
std::vector<std::string> settings_in(std::string_view condition);

/// Of calibration.conditions; without any one that changes nothing.
std::vector<std::string> conditions_of(const LoadedConfig& loaded);

/// The press of one curve: the configuration, the condition's settings, then what the problem asks.
/// Throws ConfigError for a condition that sets what is common to all curves.
LoadedConfig under(const LoadedConfig& loaded, const std::vector<std::string>& condition,
                   const std::vector<std::string>& derived);

/// The setting that asks for these indentations [m]: 'press.samples=["0.001 m"]'.
std::string samples_setting(const std::vector<double>& depths);

/// Contact, tilt, obstacle and lateral motion in words.
std::string described(const lattice::PressSetup& setup);

/// Lattice or continuum, as calibration.forward says.
LatticeUse lattice_of_fit(const LoadedConfig& loaded);
CurveKind press_kind(const CalibrationSettings& settings);

/// Appends a curve, named by its condition where it has no name, and numbered where others have its
/// name: two files of one stem, two fingers under one contact.
FitCurve& add_curve(FitInput& input, CurveKind kind, calibration::Curve curve,
                    const std::string& condition);

/// Throws ConfigError for a motion that no fit knows: aside at full depth, a program.
void refuse_motion(const LoadedConfig& own, const meshes::PressProtocol& protocol);

/// Appends a press with its curve. Throws ConfigError for a motion that no fit knows.
FitCurve& add_press(FitSetup& fit, const LoadedConfig& own, CurveKind kind,
                    calibration::Curve curve);

/// A curve per condition, whose y the continuum will make.
void add_continuum_curves(FitSetup& fit, const LoadedConfig& loaded);

/// A curve per file of calibration.data; the parameters of `fit` are known. Throws ConfigError,
/// with file and line, for files that cannot be read or do not go into one fit.
void add_measured_curves(FitSetup& fit, const LoadedConfig& loaded);

}  // namespace fingertip::studies::inline fits::inline setup
