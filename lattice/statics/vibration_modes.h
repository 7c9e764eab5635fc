/// Natural vibrations of a lattice body about rest.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "lattice/statics/lattice_body.h"

namespace fingertip::lattice::inline statics {

/// u(t) = shape cos(2 pi frequency t), undamped and free of contact.
struct VibrationMode {
  double frequency = 0.0;  ///< [Hz]
  Eigen::VectorXd shape;   ///< x per unknown, xᵀ M x = 1 [kg^-1/2]; zero where unknowns are fixed
};

/// The `count` lowest solutions of K x = (2 pi f)² M x, increasing, orthogonal: xᵀ M y = 0. K is
/// ElasticSystem's tangent at rest, bond included, M the particles' masses. A mode of multiplicity
/// n appears n times, rigid motions of a body without bond with f = 0 up to round-off (about 1e-6
/// of the lowest other frequency). Frequencies are converged to 1e-9; that they differ from the
/// continuum's is the lattice's matter (lattice/MEASUREMENTS.md). A body that is one of several
/// sectors has the modes that are symmetric about its mirror planes.
///
/// Inverse Lanczos iteration (Spectra) with a CHOLMOD factor, repeated in the complement of what
/// has been found until nothing lower turns up. Throws InvalidInput unless 1 <= count < number of
/// free unknowns and all masses are positive, NotConverged where rest is not stable, memory
/// does not suffice or the iteration does not end, and Interrupted when `stop_requested`, asked
/// between solutions with the factor, says so.
std::vector<VibrationMode> vibration_modes(const LatticeBody& body, int count,
                                           const std::function<bool()>& stop_requested = {});

}  // namespace fingertip::lattice::inline statics
