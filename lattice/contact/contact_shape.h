/// The points of a tip's outer surface, arranged for their contact with a plane.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "lattice/kernels/contact_kernel.h"
#include "lattice/model/model.h"
#include "meshes/shape/geometry.h"

namespace fingertip::lattice::inline contact {

/// The points of model.outer in groups of eight that hang on the same eight particles, and these,
/// the contact particles. Immutable.
struct ContactShape {
  std::vector<kernel::ContactGroup> groups;
  std::vector<std::uint32_t> points;     ///< numbers in model.outer, `lanes` per group
  std::vector<std::uint32_t> particles;  ///< grid index per contact particle
  std::vector<meshes::Vector3> rest;     ///< of these, along the grid's axes [m]
  std::vector<std::uint8_t> bonded;      ///< 1 where the bond holds a contact particle, too
  meshes::Vector3 centre = meshes::Vector3::Zero();  ///< of the points [m]
  double reach = 0.0;                                ///< farthest point from there [m]

  /// Which corner of which group a contact particle is: entries first_place[particle] to
  /// first_place[particle + 1] of `places`, by increasing group.
  struct Place {
    std::uint32_t group = 0, corner = 0;
  };
  std::vector<Place> places;
  std::vector<std::uint32_t> first_place;
};

std::shared_ptr<const ContactShape> contact_shape(const LatticeModel& model);

}  // namespace fingertip::lattice::inline contact
