/// How far scaled masses change the force of a press, before it is run.
#pragma once

#include <vector>

#include "lattice/press/press_setup.h"

namespace fingertip::lattice::inline press {

/// At one output depth, relative to the force there.
struct ForceDeviation {
  double indentation = 0.0;  ///< [m]
  double relative = 0.0;     ///< estimated size, not negative
};

/// What scaled masses may change of a force before it is told or shunned.
inline constexpr double tolerated_deviation = 0.02;

/// Estimates by how much the force of `setup`, pressed with masses scaled to steps of `step` [s],
/// differs from that with plain masses at vanishing steps: an envelope, not a correction. Depths at
/// which the patch's radius sqrt(R delta) is below 5/4 spacings are left out: the grid itself is
/// off by tens of per cent there.
///
/// Sway. The approach, started within T (meshes/press/press_motion.h), makes the rubber sway on its
/// rod, and the rod feels it. Of the sleeve in shear: modes w_n = (2n-1) w_1 with shares
/// mu_1/(2n-1)² of the rubber's mass m, w_1 and mu_1 by Rayleigh's quotient with the sleeve's
/// deflection under its own weight. With inertia s of its own against deformation
///
///   (1 + s) z'' + w² (z + tau z') = -a(t),  force -mu m z'',  s = 43 (w dt)²,
///
/// and the deviation is the amplitude of the difference to s = 0; of the sum, once they have come
/// apart by half a turn. The factor of s is measured
/// (lattice/MEASUREMENTS.md): ties of the bond and the V-cycle's weakness make it, and it does not
/// depend on the spacing between R/6 and R/12 or on tau up to 1.2 ms.
///
/// Contact. S is some chi (dt²/4 + dt tau/2) K, chi = 5.5 (mass_scaling.h), which filters the
/// smooth force as b F'' v², b that factor. A ring of particles, a part a/sqrt(R delta) of the
/// patch, comes to rest at once with the inertia b times its stiffness and rings on at 1/sqrt(b):
/// v sqrt(b) F' a/sqrt(R delta).
///
/// F: Hertz, with the first correction for a layer bonded to a rigid core (Dimitriadis et al.,
/// Biophys. J. 82 (2002) 2798-2810), within 4 % of the default specimen's small-strain continuum
/// that sticks.
std::vector<ForceDeviation> scaling_deviations(const PressSetup& setup, double step);

/// The largest of them at `from` [m] and deeper; none: 0.
ForceDeviation worst_of(const std::vector<ForceDeviation>& deviations, double from = 0.0);
/// Where the choice of a step begins to look: a sixth of the depth [m]. Before, the patch is a few
/// cells, and nothing short of plain masses keeps to two per cent.
double judged_from(const PressSetup& setup);

/// What `run.integrator = mass-scaled` does in a press.
struct ScalingChoice {
  bool scaled = true;  ///< false: plain masses
  double step = 0.0;   ///< largest one [s]; of plain masses that of the infinite lattice
  std::vector<ForceDeviation> deviations;  ///< where scaled
};

/// With the step that `setup` asks for, or else with the longest one up to 250 us that deviates by
/// at most `tolerated_deviation` from judged_from() on. A scaled step costs as much as two plain
/// ones, so plain masses are chosen where that step would not be twice as long as theirs.
ScalingChoice choose_scaling(const PressSetup& setup);
/// As if `setup` asked for no step.
ScalingChoice best_scaling(const PressSetup& setup);
/// The same with steps up to `longest` [s], judged from another indentation on [m].
ScalingChoice best_scaling(const PressSetup& setup, double longest, double from);

/// Largest stable step of plain masses on the infinite lattice, at rest [s].
double plain_step(const PressSetup& setup);

/// The force [N] that the estimate uses, at an indentation [m] >= 0.
double rough_force(const meshes::Geometry& geometry, const meshes::Rubber& rubber,
                   double indentation);

/// At the depth of the press, pressed at once where the rubber relaxes [N]: the larger one of
/// rough_force and, for poles that are flat, of a layer as wide as the finger is at half the depth,
/// r, bonded at one side and held by friction at the other, h thick:
///
///   F = E (1 + 2 S²) pi r² depth/h,  S = r/(2 h),
///
/// at most M in place of E (1 + 2 S²) (A. N. Gent, Engineering with Rubber, 2012, section 8.3: of
/// an incompressible block, whose shape factor S is loaded over free area). Right within a factor
/// of three for domes and pads up to a third of their thickness.
double expected_force(const PressSetup& setup);

/// What the actuator of such a press does not meet: three times the expected force [N], and that at
/// the distance of the pole from the endpoint [N m]; two digits.
struct ActuatorLimits {
  double force = 0.0, torque = 0.0;
};
ActuatorLimits suitable_limits(const PressSetup& setup);

}  // namespace fingertip::lattice::inline press
