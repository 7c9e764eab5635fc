/// A complete, resolved order for every verb: what the key table's values add up to.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/moduli_fit.h"
#include "fem_reference/job.h"
#include "lattice/settings.h"

namespace fingertip::studies {

/// Where the spring constants come from (key lattice.constants).
enum class ConstantsSource {
  automatic,   ///< published: its rule; central: fit; hookean, network: closed form
  rule,        ///< published and central: k = E a²/l0; hookean, network: closed form
  calibrated,  ///< fit to the rubber's moduli (central, hookean)
  file,        ///< a material.toml written by `calibrate`
};

/// SI throughout. The spring constants in `press.lattice` are empty until
/// `studies/run/press_setup.h` resolves them.
struct Config {
  lattice::PressSetup press;
  ConstantsSource constants = ConstantsSource::automatic;
  std::filesystem::path constants_file;           ///< absolute; only for ConstantsSource::file
  std::optional<lattice::Kinematics> kinematics;  ///< as asked for; empty: the model's default
  std::vector<double> rotation;                   ///< of the grid about x, y, z in turn [rad]
  int lattice_modes = 10;                         ///< how many natural frequencies
  std::optional<double> spacing_divisor;          ///< a = R/divisor when given so
  fem_reference::ReferenceJob reference;
  int fit_starts = 10;
  unsigned fit_seed = 1;
};

/// The model's own kinematics: published and network finite, central and hookean small.
inline lattice::Kinematics default_kinematics(lattice::ModelKind model) {
  using lattice::ModelKind;
  return model == ModelKind::published || model == ModelKind::network ? lattice::Kinematics::finite
                                                                      : lattice::Kinematics::small;
}

}  // namespace fingertip::studies
