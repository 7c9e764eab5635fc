/// Calibrations as files: calibration.json for scripts, material.toml for the next press.
#pragma once

#include <filesystem>
#include <string>

#include "calibration/moduli_fit.h"
#include "lattice/constants.h"
#include "meshes/rubber.h"

namespace fingertip::calibration {

/// Calibrated constants as they travel from one run to another; SI.
struct Material {
  lattice::ModelKind model = lattice::ModelKind::hookean;
  double spacing = 0.0;  ///< a at which the constants hold [m]
  lattice::SpringConstants constants;
  meshes::Rubber rubber;   ///< the rubber they stand for
  std::string provenance;  ///< how they were found
  std::string validity;    ///< where they may be used
};

/// The constants for another spacing [m], > 0: k ∝ a leaves the moduli (∝ k/a) as they are, and
/// kappa is a modulus itself.
lattice::SpringConstants at_spacing(const Material& material, double spacing);

/// The material that `fit` describes, with provenance and validity filled in.
Material material_from(const ModuliFit& fit);

/// calibration.json: model, spacing, constants {k1, k2, k3, kappa}, damping, target, achieved,
/// covariance (null: the targets are exact numbers, not measurements), unidentifiable, residuals,
/// statement; all SI. Written atomically. Throws std::runtime_error when the file cannot be
/// written.
void write_calibration_json(const ModuliFit& fit, const std::filesystem::path& file);

/// material.toml: every quantity a string with its SI unit, "1.144 N/m". Written atomically, reads
/// back to the same bits. Throws std::runtime_error when the file cannot be written.
void write_material_toml(const ModuliFit& fit, const std::filesystem::path& file);

/// Reads material.toml. Throws InvalidInput naming file, line and key for a file that cannot be
/// read or parsed, a missing or unknown key, a wrong unit or a value out of range.
Material read_material_toml(const std::filesystem::path& file);

}  // namespace fingertip::calibration
