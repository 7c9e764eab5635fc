/// From a configuration to a complete lattice press: spring constants resolved, all rules checked.
#pragma once

#include "calibration/moduli_fit.h"
#include "lattice/settings.h"
#include "studies/config/loader.h"

namespace fingertip::studies {

/// The press that `loaded` describes, with spring constants for its spacing. Throws ConfigError
/// for every rule of lattice, rod and controller it breaks, for constants that do not go with the
/// model, and for a material.toml that cannot be used; NotConverged when a fit fails.
lattice::PressSetup press_setup(const LoadedConfig& loaded);

/// The continuum's order. Throws ConfigError.
fem_reference::ReferenceJob reference_order(const LoadedConfig& loaded);

/// Options of the fit for `model` at the configuration's spacing.
calibration::ModuliFitOptions fit_options(const LoadedConfig& loaded, lattice::ModelKind model);

/// Checks everything that does not depend on the verb: press_setup and reference_order, but not
/// whether the lattice can do what the continuum is asked for. Throws ConfigError.
void check_all(const LoadedConfig& loaded);

/// What `validate` needs beyond check_all: a press that both can do. Throws ConfigError.
void check_validation(const LoadedConfig& loaded);

}  // namespace fingertip::studies
