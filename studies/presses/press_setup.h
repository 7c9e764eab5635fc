/// From a configuration to a complete lattice press: spring constants resolved, all rules checked.
#pragma once

#include "calibration/moduli/moduli_fit.h"
#include "lattice/press/press_setup.h"
#include "studies/config/loader.h"

namespace fingertip::studies::inline presses {

/// What a lattice is used for: how it is pressed does not matter to natural frequencies. Where the
/// continuum answers none is built, and a spacing that nobody gave is not checked.
enum class LatticeUse { press, modes, none };

/// `loaded`, and where lattice.constants is a file: what it says in place of defaults (moduli,
/// density and retardation time of the rubber, factors on bond and contact), for presses a density
/// of the rod that the controller can move, where nobody gave one; and as notes where the
/// lattice is used outside of what the file is good for. A spacing chosen for the finger is a note,
/// too, where a lattice is built. The entries name the file as their source,
/// so that the parameters of a run remain complete. Throws ConfigError for a file that cannot be
/// used or is for another model.
LoadedConfig with_material(const LoadedConfig& loaded, LatticeUse use);

/// The press that `loaded` describes, with spring constants for its spacing, and with_material. The
/// stiffness is that of a material's file, whatever moduli the configuration gives. Throws
/// ConfigError for every rule of lattice, rod and controller it breaks, for constants that do not
/// go with the model, and for a material.toml that cannot be used; NotConverged when a fit fails.
lattice::PressSetup press_setup(const LoadedConfig& loaded, LatticeUse use = LatticeUse::press);

/// What the equilibrium of a press at rest takes, within a quarter; 0 for one in motion [byte].
double equilibrium_memory(const lattice::PressSetup& press);

/// For fingers that somebody moves while they are pressed, and for what is not a press's force
/// (vibrations, a grasp): where neither a spacing nor lattice.tolerance is given, 5 % of tolerance.
LoadedConfig at_pace(const LoadedConfig& loaded);

/// The press of a finger whose rod nobody moves but the caller (press.mode pid), for loops of
/// others, at_pace. Throws as press_setup.
lattice::PressSetup free_press(ConfigSource source);

/// The continuum's job. Throws ConfigError.
fem_reference::ReferenceJob continuum_setup(const LoadedConfig& loaded);

/// Its press at rest, whatever reference.mode says, at this strain, without fields. Throws
/// ConfigError.
fem_reference::ReferenceJob continuum_at_rest(const LoadedConfig& loaded,
                                              fem_reference::Strain strain);
fem_reference::Strain strain_of(lattice::Kinematics kinematics);

/// The continuum beside a press: at rest, linear or law A as `kinematics` says, without markers.
fem_reference::ReferenceJob continuum_beside(const LoadedConfig& loaded,
                                             lattice::Kinematics kinematics);

/// Options of the fit for `model` at the configuration's spacing.
calibration::ModuliFitOptions fit_options(const LoadedConfig& loaded, lattice::ModelKind model);

/// What a lattice of a valid configuration cannot do (lattice::beyond_the_lattice), and that its
/// spacing makes too many masses for this machine.
std::vector<meshes::Violation> beyond_the_lattice(const LoadedConfig& loaded);

/// Checks everything that does not depend on the verb: press_setup and continuum_setup, but not
/// whether the lattice can do what the continuum is asked for. Throws ConfigError.
void check_all(const LoadedConfig& loaded);

/// What `validate` needs beyond check_all: a press that both can do. Throws ConfigError.
void check_validation(const LoadedConfig& loaded);

}  // namespace fingertip::studies::inline presses
