/// Inertia of what hangs on the rod and on the plane.
#pragma once

#include <cstdint>
#include <span>

#include "lattice/model/rod.h"
#include "meshes/shape/geometry.h"

namespace fingertip::lattice::inline contact {

/// What ties to the rod add to a particle's inertia (tied_bond.h).
struct BondInertia {
  std::uint32_t particle = 0;  ///< grid index
  double inertia = 0.0;        ///< [kg]
};

/// What ties to the plane add to a particle's inertia (penalty_contact.h).
struct ContactInertia {
  std::uint32_t particle = 0;                         ///< grid index
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< along the grid's axes [kg]
  meshes::Vector3 rest = meshes::Vector3::Zero();     ///< of the particle, likewise [m]
};

/// How the plane holds the tip, along the grid's axes.
struct PlaneHold {
  std::span<const ContactInertia> ties;
  meshes::Vector3 normal = meshes::Vector3::UnitZ();
  /// What it does to the tip if particles accelerate as the forces say: [N], and [N m] about the
  /// origin.
  Wrench wrench;
};

}  // namespace fingertip::lattice::inline contact
