/// Motions of a lattice that cost no energy.
#pragma once

#include <Eigen/Eigenvalues>

#include "lattice/statics/cube.h"

/// Besides the six rigid ones: modes with an eigenvalue below 1e-10 of the largest. Dense, so for
/// cubes of a few cells.
inline int count_mechanisms(const fingertip::lattice::CubeLattice& cube) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(Eigen::MatrixXd(cube.stiffness),
                                                             Eigen::EigenvaluesOnly);
  const double zero = 1e-10 * modes.eigenvalues().maxCoeff();
  return int((modes.eigenvalues().array().abs() < zero).count()) - 6;
}
