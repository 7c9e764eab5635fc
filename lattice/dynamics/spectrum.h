/// How stiff and how viscous the lattice can get: bounds on the eigenvalues that limit an explicit
/// time step.
#pragma once

#include <Eigen/Core>

#include "lattice/model/model.h"
#include "lattice/model/rod.h"
#include "lattice/model/state.h"

namespace fingertip::lattice::inline dynamics {

/// What limits the step, over all motions of particles and rod (README: stable steps).
struct SpectralBounds {
  double stiffness = 0.0;  ///< lambda: largest eigenvalue of M⁻¹K is at most this [1/s²]
  double damping = 0.0;    ///< c: largest eigenvalue of M⁻¹C is at most this [1/s]
  double shortest_retardation = 0.0;  ///< smallest mu/k of any spring, cell or ligament [s]
  double longest_retardation = 0.0;   ///< largest mu/k [s]
};

/// m^(-1/2) per particle and axis of the grid, 0 along which a mirror plane holds it [kg^(-1/2)].
Eigen::MatrixX3d mobility(const LatticeModel& model);

/// Rigorous upper bounds for a lattice of springs and ligaments alone: lambda <= max over particles
/// of the largest eigenvalue of (2/m) Σ k d̂d̂ᵀ, ligaments added particle by particle. `rod` null:
/// bonded to a rod that cannot move.
SpectralBounds spectral_bounds(const LatticeModel& model, const RodBody* rod);

/// Largest eigenvalues of the rod alone on its ligaments or its tied bond, the particles held; no
/// retardation times.
SpectralBounds rod_bounds(const LatticeModel& model, const RodBody& rod);

/// Largest eigenvalues at rest by the Lanczos method with the rod held, from below; converged to a
/// few parts in 10⁴. Bond and penalty contact are left out: they do not limit the step
/// (tied_bond.h). Retardation times as in spectral_bounds.
SpectralBounds spectral_estimate(const LatticeModel& model);

/// The same about another state, its velocity included, with `steps` Lanczos steps; 30 are good to
/// one or two per cent.
SpectralBounds spectral_estimate(const LatticeModel& model, const State& at, int steps);

}  // namespace fingertip::lattice::inline dynamics
