/// What jobs of presses, in time and at rest, have in common: inputs, weight, the summary's head.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>

#include "calibration/material/moduli.h"
#include "lattice/press/press_setup.h"
#include "studies/files/press_summary.h"

namespace fingertip::studies::inline presses {

/// Takes entries out that have no effect.
void drop(nlohmann::ordered_json& inputs, std::initializer_list<const char*> idle);

/// Of a press that is computed in time (`moves`) or at rest.
nlohmann::ordered_json inputs_of(const meshes::PressProtocol& protocol, bool moves);

/// A rubber as input of a lattice: at small strain its law has no say.
nlohmann::ordered_json rubber_inputs(const meshes::Rubber& rubber, lattice::Kinematics kinematics);

/// What a press depends on, for `Job::inputs`: all members but those that have no effect. Static
/// presses know neither time nor controller.
nlohmann::ordered_json inputs_of(const lattice::PressSetup& setup);

/// What a press weighs (Job::weight): masses ~ 1/a³, steps in time, or of Newton, ~ 1/a.
double press_weight(const lattice::PressSetup& setup);

/// What the summary.json of every press begins with.
PressSummary press_summary_head(const lattice::PressSetup& setup, const std::string& status);

GeometryEntry geometry_entry(const meshes::Geometry& geometry);
ConstantsEntry constants_entry(const lattice::SpringConstants& constants);
ModuliEntry moduli_entry(const calibration::ElasticModuli& moduli);

/// Writes `status` into the folder's summary.json, if there is one.
void set_press_status(const std::filesystem::path& folder, const std::string& status);

}  // namespace fingertip::studies::inline presses
