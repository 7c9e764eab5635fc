/// Defaults that depend on the finger: what nobody set never makes a valid finger refuse.
#pragma once

#include "studies/config/loaded_config.h"

namespace fingertip::studies::inline config {

/// Where press.depth and calibration.depth are left at defaults that this finger cannot have, a
/// tenth of its thickness. The entries say so in place of "default".
void choose_for_finger(LoadedConfig& loaded);

/// Of lattice.spacing = "auto" the coarsest tip_radius/N, N whole, that the finger's walls allow
/// and whose estimate (lattice::ForceEstimator::at) keeps lattice.tolerance from the first asked
/// depth on, or from a tenth of the depth, with no more masses than lattice.max_particles where the
/// walls allow that; of every model that of a hookean lattice, so that models stand on one grid.
/// The configuration must be valid.
void choose_automatic_spacing(LoadedConfig& loaded);

/// From which depth on [m] an automatic spacing keeps lattice.tolerance: the first that is asked
/// for, or a tenth of the depth.
double first_kept_depth(const LoadedConfig& loaded);

/// Where both are automatic the spacing of `of`, or the coarsest that this finger allows: for
/// presses of one fit or one case.
void keep_spacing(LoadedConfig& loaded, const LoadedConfig& of);

/// The same of controller.force_limit and torque_limit, where a press under the controller is
/// expected to meet them: lattice::suitable_limits. The configuration must be valid.
void choose_limits(LoadedConfig& loaded);

/// What choose_automatic_spacing has taken and what that is good for; empty where a spacing is
/// given.
std::string spacing_note(const LoadedConfig& loaded);

/// Where little of what may touch rules the spacing: how much rubber lies behind the rest, and what
/// lattice would do for that. Empty for fingers of nearly one wall, and for domes.
std::string thin_part(const meshes::Geometry& geometry);

}  // namespace fingertip::studies::inline config
