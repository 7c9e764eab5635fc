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
  std::uint32_t particle = 0;            ///< grid index
  double along = 0.0, tangential = 0.0;  ///< along the plane's normal, and in the plane [kg]
  meshes::Vector3 rest = meshes::Vector3::Zero();  ///< of the particle, along the grid's axes [m]
};

/// How the plane holds the tip, along the grid's axes.
struct PlaneHold {
  std::span<const ContactInertia> ties;
  meshes::Vector3 normal = meshes::Vector3::UnitZ();
  /// What it does to the tip if particles accelerate as the forces say: [N], and [N m] about the
  /// origin.
  Wrench wrench;

  /// What it takes for that acceleration of a particle [N].
  meshes::Vector3 taken(const ContactInertia& tie, const meshes::Vector3& acceleration) const {
    return tie.tangential * acceleration +
           (tie.along - tie.tangential) * normal.dot(acceleration) * normal;
  }
};

}  // namespace fingertip::lattice::inline contact
