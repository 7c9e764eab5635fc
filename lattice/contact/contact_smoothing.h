/// Pressure and shear of a contact that is known by the forces of ties.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "meshes/press/contact_field.h"
#include "meshes/press/contact_patch.h"

namespace fingertip::lattice::inline contact {

/// A point of the outer surface with its own tie's force, none where it does not touch, and the
/// particles around it.
struct TiedPoint {
  meshes::ContactPoint point;
  std::array<std::uint32_t, 8> particles{};
  std::array<double, 8> weights{};

  bool touches() const { return point.normal_traction != 0.0; }
};

/// The field of the whole contact from the points of one of `sectors` parts, all those that may
/// touch, along the field's axes (meshes::ContactPoint).
///
/// Neighbouring ties share their load unevenly, for they outnumber the particles around them; what
/// a particle gets of them, F_c, is right. A pressure q on the points would load it with
/// G_c = Σ_j w_jc A_j q_j, and the field is
///   p_j = q_j Σ_c w_jc F_c/G_c,
/// shear likewise from the particles' shear. q is the profile of `patch`, whose moments know the
/// contact's edge better than points half a spacing apart: of three and more spacings over the
/// radius the field is within 2.3 % of the continuum's p0 in L2, from five on within 1.6 %
/// (lattice/MEASUREMENTS.md, contact). Where the contact is no ellipse, q is 1 where it touches.
///
/// Ties slide where their own load is low, though the contact around them sticks. A point slips
/// where three quarters of its load are on ties that slide, along the shear of the field.
///
/// Sums over the points stay nearly as they are; f_j += |f_j| (a + b × x_j), along the normals
/// where there is no shear, makes force and torque those of the ties to round-off.
std::vector<meshes::ContactPoint> contact_field(std::span<const TiedPoint> points,
                                                const meshes::ContactPatch& patch, int sectors);
/// With the patch of the points' own forces.
std::vector<meshes::ContactPoint> contact_field(std::span<const TiedPoint> points, int sectors);

}  // namespace fingertip::lattice::inline contact
