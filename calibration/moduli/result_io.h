/// The fit to the moduli in words, as a file and as a material.
#pragma once

#include <filesystem>
#include <string>

#include "calibration/material/material.h"
#include "calibration/moduli/moduli_fit.h"

namespace fingertip::calibration::inline moduli {

/// What `fit` reached, why it cannot reach more, which constants the tests leave open and how the
/// choice among them was made; SI.
std::string fit_statement(const ModuliFit& fit);

/// The material that `fit` describes, with provenance, validity and statement filled in. Moduli
/// know neither spacing, depth nor contact, so these have no bounds.
Material material_from(const ModuliFit& fit);

/// calibration.json: model, spacing, constants {k1, k2, k3, kappa}, damping, target, achieved,
/// covariance (null: the targets are exact numbers, not measurements), unidentifiable, residuals,
/// statement; all SI. Written atomically. Throws std::runtime_error when the file cannot be
/// written.
void write_calibration_json(const ModuliFit& fit, const std::filesystem::path& file);

}  // namespace fingertip::calibration::inline moduli
