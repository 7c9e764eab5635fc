/// How far a press's force is off: by scaled masses, before it is run, and by the lattice itself.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "lattice/press/press_setup.h"
#include "meshes/press/markers.h"
#include "meshes/press/press_response.h"

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

/// How far a lattice's force is off the continuum's in the same press without inertia and damping,
/// relative to the force: sizes, none negative.
struct ForceEstimate {
  double contact = 0.0;  ///< of masses a spacing apart, where they touch
  double inside = 0.0;   ///< of the same across the wall, and of the ties
  double model = 0.0;    ///< of what the model's springs cannot be, however fine
  double motion = 0.0;   ///< of inertia and damping of the rubber, and of scaled masses
  double steps = 0.0;    ///< of the steps of a press at rest, as told by the sample
  /// Of the pressures besides, which does not change their sum: root mean square over the contact,
  /// over the largest.
  double profile = 0.0;
  double grid() const { return contact + inside; }
  double sum() const { return grid() + model + motion + steps; }
};

/// Estimates for the samples of one press. None of `published`, whose springs have no modulus of
/// the rubber's.
///
/// Grid. At a given depth the force is the slope of the least energy, and displacements that are
/// linear between masses can only have more of it. About a contact of radius a they miss a smooth
/// displacement by (h/a)² in energy, h the spacing, and across a wall w by (h/w)². The contact's
/// edge, known to a mass, costs a pressure ~ (h/a)^1/2 on a gap ~ (h/a)^3/2 over a ring ~ h/a, thus
/// (h/a)³. Where a few masses touch, their force grows with the depth delta, and not with
/// delta^3/2: what is off depends on h over the radius that Hertz' patch has.
///
///   A x² + B x³ + D y² + T <= max(C, E z),  x = h/a, y = h/w, z = h/sqrt(R delta),
///
/// a that of the sample, of an elongated one (cylinders, edges) so that x² is the mean over its
/// half axes, R of both bodies together, T that of the ties, which are a little soft on any grid
/// (lattice/MEASUREMENTS.md). A to T cover 95 % of the samples of presses drawn by a seed
/// (tests/judgement/drawn_presses.py; others judge). Programs and rubbers that relax are not among
/// them.
///
/// Profile. Where the contact ends is known to a mass: P x^3/2, with what the force is off 95 % of
/// the same presses' fields (drawn_presses.py --fields).
///
/// Edge. What sticks carries shear that grows like 1/sqrt of the distance from its edge, which
/// displacements linear between masses follow no better than to a cell, and a cell of which a part
/// sticks moves as one. Both make the radius of what sticks larger, by up to e h. Normal forces are
/// stationary in it; lateral stiffness, 8 G a/(2 - nu) (Mindlin, J. Appl. Mech. 16 (1949) 259),
/// goes with it, torsion, 16 G a³/3 (Reissner & Sagoci, J. Appl. Phys. 15 (1944) 652), with its
/// cube: e x, 3 e x; of the place of the centre 2/3 e x, for some of e is there all around. Where
/// Coulomb's friction holds the share s of what it can, the part w of that is left which the
/// stiffness has in the force: Mindlin's w = d ln Q/d ln u = 3/2 (1-s)^1/3 (1 - (1-s)^2/3)/s for s
/// = Q/(mu N), and for s = M/(3 pi/16 mu N a) w = sqrt(1-s), within 0.1 of Lubkin's (J. Appl. Mech.
/// 18 (1951) 183). What slips answers to the pressure, Q as N does; M has it times the radius, of
/// which the edge's part B x³ counts thrice. So for what is turned or pushed aside once: right
/// after the way has turned, shares are larger. e covers 95 % of drawn_presses.py --turned.
///
/// Model. `central` has nu = 1/4 in all its directions, whatever the rubber has: the rough force
/// (Hertz on a layer, scaling_deviations above) of both, at one E. Its G is right, and so torsion;
/// aside 8 G a/(2 - nu) is off by (2 - nu)/(2 - 1/4) - 1.
///
/// Motion, in presses in time alone, at the largest speed of a program. Kelvin-Voigt damping adds
/// tau dF/dt; the sway of the rubber and what scaled masses change are those of
/// scaling_deviations.
class ForceEstimator {
 public:
  explicit ForceEstimator(const PressSetup& setup);

  /// Nothing of samples without force, depth or contact radius.
  std::optional<ForceEstimate> of(const meshes::PressSample& sample) const;
  /// Of a sample whose `estimate` that is: of its normal force, and with the edge of what sticks of
  /// its lateral force and torque.
  meshes::RelativeErrors errors(const meshes::PressSample& sample,
                                const ForceEstimate& estimate) const;
  /// Of the displacement of a marker [m], its length; unknown where there is no estimate. The
  /// shares by which normal force, lateral force and torque are off, each of the way that they go
  /// with (indentation, lateral displacement, twist times the contact's radius), times
  /// meshes::marker_share. `central` besides sends material outward by another Poisson's ratio, at
  /// the surface of a half space u_r = -(1 - 2 nu)/(2 (1 - nu)) u_z (Boussinesq), which is off by
  /// the difference to nu = 1/4 of u_z ~ delta a/r. Covers 99 % of the markers of presses drawn by a seed, 93 % of the worst press's,
  /// with a median ratio to the true error of 2.4 (lattice/MEASUREMENTS.md, press).
  double displacement_error(const meshes::PressSample& sample,
                            const meshes::MarkerRow& marker) const;
  /// Before there is a press, at `depth` [m] > 0: with the radius of Hertz' patch, 0.95 to 1.15 of
  /// that of presses to 0.3 of the wall.
  std::optional<ForceEstimate> at(double depth) const;
  /// The spacing [m] at which the grid's part of at() is `tolerance` at `depth` [m] > 0, of
  /// `published` that of a hookean lattice; may be coarser than a lattice can be
  /// (coarsest_spacing), and is 0 where the ties alone are worse.
  double spacing_for(double depth, double tolerance) const;

 private:
  struct Terms;
  std::shared_ptr<const Terms> terms_;
  bool knows_model() const;
};

}  // namespace fingertip::lattice::inline press
