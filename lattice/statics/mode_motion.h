/// What kind of motion a natural vibration of the tip is.
#pragma once

#include <Eigen/Core>
#include <string>

#include "lattice/statics/lattice_body.h"

namespace fingertip::lattice::inline statics {

/// Of a shape u about the tip's axis z, all dimensionless. Masses m_i at X_i, M = Σ m_i,
/// J = Σ m_i (x² + y²), Σ m_i |u_i|² = 1.
struct ModeMotion {
  /// Effective modal mass: (Σ m_i u_i)² / M per axis. What share of the mass answers when the rod
  /// shakes along it; over all modes it adds up to 1 minus what the bond holds.
  Eigen::Vector3d effective_mass = Eigen::Vector3d::Zero();
  /// The same of the moment of inertia about the axis: (Σ m_i (x u_y - y u_x))² / J.
  double effective_inertia = 0.0;
  /// Shares of the kinetic energy: radial, around the axis, along it; their sum is 1.
  double radial = 0.0, circumferential = 0.0, axial = 0.0;
  /// Waves around the axis: u_r, u_z ~ cos(n phi + c), u_phi ~ sin. That n of 0 to 3 that carries
  /// most kinetic energy; 4 where none of them carries half of it.
  int waves = 0;
};

/// `shape`: x per unknown of the whole tip (body.sectors = 1), normalised as VibrationMode's.
/// `spacing` of the grid [m]: particles of equal distance from the axis and equal height, to half
/// of it, make a ring.
ModeMotion motion_of(const LatticeBody& body, const Eigen::VectorXd& shape, double spacing);

/// "torsion", "along the axis", "breathing", "sideways", "2 waves around the axis", ...,
/// "4 or more waves around the axis".
std::string description(const ModeMotion& motion);

}  // namespace fingertip::lattice::inline statics
