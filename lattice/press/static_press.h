/// The press without time: a path of equilibria.
#pragma once

#include <functional>
#include <vector>

#include "lattice/press/press_pictures.h"
#include "lattice/press/press_setup.h"
#include "lattice/press/press_slopes.h"
#include "lattice/statics/lattice_body.h"
#include "meshes/press/contact_field.h"
#include "meshes/press/markers.h"
#include "meshes/press/press_response.h"

namespace fingertip::lattice::inline press {

/// Counts are those of the part computed, 1/sectors of the tip; forces, torques, radii and contact
/// points are the whole tip's. Of the response's columns time and force_error stay unknown;
/// step_error is StepError's, of what sticks.
/// contact_radius and max_pressure are those of the field: true ones at finite strain, at small
/// strain those of the shape at rest. How far off they are stands in
/// lattice/MEASUREMENTS.md (contact).
struct StaticOutcome : PressShapes {  // empty unless it was to be pictured
  meshes::PressResponse response;     ///< at the samples of the protocol's path
  std::size_t particles = 0, cells = 0, springs = 0, unknowns = 0;
  int sectors = 1;
  double volume = 0.0, exact_volume = 0.0;  ///< of the rubber, whole tip [m³]
  int steps = 0, newton_iterations = 0, factorisations = 0, gradients = 0;
  double smallest_jacobian = 1.0;             ///< over all cells and steps
  double wall_time = 0.0;                     ///< [s]
  std::vector<meshes::ContactPoint> contact;  ///< of every sample finished
  std::vector<meshes::MarkerRow> markers;     ///< the same; errors are left to others
};

/// The lattice of `setup` as lists: the published model on its own particles (sectors = 1), the
/// others on cut cells. Throws InvalidInput as build_tip and build_cut_tip do.
LatticeBody static_body(const PressSetup& setup, int sectors);

/// Called after every sample and after the steps between; false ends the press with Interrupted.
using StaticObserver = std::function<bool(const StaticOutcome& so_far, double fraction_done)>;

/// Presses `setup`'s lattice quasi-statically along the protocol's PressPath, under any contact
/// law, with tilt, lateral motion and twist. Contact is a one-sided elastic tie of every outer
/// point to the plane (EmbeddedPoint::stiffness): frictionless along the normal; stick to the place
/// where the point first touched, interpolated within the step, and released when pulled; coulomb
/// as stick, along the plane no more than friction holds. Steps are at most (R - r)/10, of what
/// sticks as long as leaves the force in doubt by 0.2 % (StepError); (R - r)/40 where the plane
/// turns and for the published model, (R - r)/100 under coulomb, one to a sample without friction
/// at small strain; a step that fails is halved, down to (R - r)/12800. The published model is
/// computed on its own particles, the others on cut cells, on the smallest part that symmetry
/// allows. Of `setup`, the protocol's mode, rod, controller and integrator do not matter. Throws
/// InvalidInput for a setup that breaks a rule, NotConverged when Newton's method fails at the
/// smallest step (the observer has seen what was finished), Interrupted when the observer asks. A
/// press that is `pictured` builds the whole tip as a moving lattice, too: snapshots are at rest,
/// at the first sample from half the depth on, and at the last sample.
StaticOutcome run_static_press(const PressSetup& setup, const StaticObserver& observer = {},
                               bool pictured = false);

/// The same with a body of one's own, made for `setup` (largest_symmetry for its sectors).
StaticOutcome run_static_press(const PressSetup& setup, const LatticeBody& body,
                               const StaticObserver& observer = {});

struct StaticOutcomeWithSlopes {
  StaticOutcome outcome;
  PressSlopes slopes;
};

/// run_static_press, and the derivatives of its forces in `directions` (which may be
/// none): exact for the path computed, as long as every point touches, slides or is released in the
/// same step. All states are in equilibrium to slope_tolerance, so that forces may differ from
/// run_static_press's by what its coarser search for the points that stick leaves, and finite
/// differences of them are good for comparison. Throws InvalidInput as body_slope does,
/// NotConverged also where a tangent is not positive definite.
StaticOutcomeWithSlopes run_static_press_with_slopes(const PressSetup& setup,
                                                     const PressDirections& directions,
                                                     const StaticObserver& observer = {});

}  // namespace fingertip::lattice::inline press
