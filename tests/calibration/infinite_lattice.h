/// The infinite lattice worked out spring by spring, independently of the homogenised formulas.
#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "lattice/model/constants.h"

namespace infinite_lattice {

struct Bond {
  Eigen::Vector3d vector;  ///< [m]
  double stiffness;        ///< [N/m]
};

/// The 13 springs that one particle contributes to the periodic lattice (half of its 26).
inline std::vector<Bond> half_stencil(const fingertip::lattice::SpringConstants& c, double a) {
  std::vector<Bond> bonds;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        if (9 * x + 3 * y + z <= 0) continue;
        const int kind = x * x + y * y + z * z;
        bonds.push_back({a * Eigen::Vector3d(x, y, z), kind == 1 ? c.k1 : kind == 2 ? c.k2 : c.k3});
      }
  return bonds;
}

/// Energy per volume [Pa] of the affine deformation with the symmetric strain `strain`.
inline double energy_density(const fingertip::lattice::SpringConstants& c, double a,
                             const Eigen::Matrix3d& strain) {
  double energy = 0.5 * c.kappa * strain.trace() * strain.trace() * a * a * a;
  for (const Bond& bond : half_stencil(c, a)) {
    const double elongation = bond.vector.normalized().dot(strain * bond.vector);
    energy += 0.5 * bond.stiffness * elongation * elongation;
  }
  return energy / (a * a * a);
}

/// Stiffness [N/m] of the plane wave u = A cos(q·x), per particle: eigenvalues ascending.
inline Eigen::Vector3d wave_stiffness(const fingertip::lattice::SpringConstants& c, double a,
                                      const Eigen::Vector3d& q) {
  Eigen::Matrix3d dynamical = Eigen::Matrix3d::Zero();
  for (const Bond& bond : half_stencil(c, a)) {
    const Eigen::Vector3d n = bond.vector.normalized();
    dynamical += 2.0 * bond.stiffness * (1.0 - std::cos(q.dot(bond.vector))) * n * n.transpose();
  }
  // Mean dilatation of a cell under the wave: differences along one axis, averaged over the others.
  const Eigen::Array3d half = 0.5 * a * q.array();
  const Eigen::Array3d s = half.sin(), d = half.cos();
  const Eigen::Vector3d dilatation =
      2.0 / a * Eigen::Vector3d(s(0) * d(1) * d(2), d(0) * s(1) * d(2), d(0) * d(1) * s(2));
  dynamical += c.kappa * a * a * a * dilatation * dilatation.transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(dynamical).eigenvalues();
}

/// Stiffness [N/m] of the softest wave on the zone boundary q = (π/a, y, z), |y|, |z| <= π/a; by
/// symmetry 0 <= z <= y suffices. A continuum-like lattice has the stiffness 4 G a of its shear
/// wave along a cube axis there, a mechanism has zero.
inline double softest_zone_boundary_wave(const fingertip::lattice::SpringConstants& c, double a,
                                         int divisions = 16) {
  const double unit = std::numbers::pi / (divisions * a);
  double softest = std::numeric_limits<double>::infinity();
  for (int y = 0; y <= divisions; ++y)
    for (int z = 0; z <= y; ++z) {
      const Eigen::Vector3d q = unit * Eigen::Vector3d(divisions, y, z);
      softest = std::min(softest, wave_stiffness(c, a, q)(0));
    }
  return softest;
}

}  // namespace infinite_lattice
