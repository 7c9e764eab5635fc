/// Pressure and shear of a contact that is known by the forces of ties.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lattice/model/plane.h"
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

/// The ellipse that the points' forces fit, judged by what their particles bear.
meshes::ContactPatch tied_patch(std::span<const TiedPoint> points, int sectors);

/// The field of the whole contact from the points of one of `sectors` parts, all those that may
/// touch, along the field's axes (meshes::ContactPoint). It is where radius, area, mean pressure,
/// peak and centre of the contact come from.
///
/// Neighbouring ties share their load unevenly, for they outnumber the particles around them; what
/// a particle gets of them, F_c, is right. A pressure q on the points would load it with
/// G_c = Σ_j w_jc A_j q_j, and the field is
///   p_j = q_j Σ_c w_jc F_c/G_c,
/// where F_c/G_c, which the points' uneven density moves by up to 4 %, is averaged over neighbours
/// (in an ellipse). Shear likewise from the particles' shear, in the
/// proportion to the pressure that it has before averaging.
/// q is the profile of `patch`, whose moments know the contact's edge better than points half a
/// spacing apart; where that is an ellipse, the points have its area, for which those at its edge
/// are given more or less of theirs. Of three and more spacings over the radius the field is within
/// 2.3 % of the continuum's p0 in L2, from five on within 1.6 % (lattice/MEASUREMENTS.md, contact).
/// Where the contact is no ellipse, q is 1 where it touches.
///
/// Ties slide where their own load is low, though the contact around them sticks. A point slips
/// where three quarters of its load are on ties that slide, along the shear of the field.
///
/// Sums over the points stay nearly as they are; f_j += |f_j| (a + b × x_j), along the normals
/// where there is no friction and within Coulomb's cone where the law is his, makes force and
/// torque those of the ties to round-off. Should no such field exist, the sums are kept and shear
/// exceeds mu p.
std::vector<meshes::ContactPoint> contact_field(std::span<const TiedPoint> points,
                                                const meshes::ContactPatch& patch, int sectors,
                                                const ContactLaw& law);
/// With the patch of the points' own forces.
std::vector<meshes::ContactPoint> contact_field(std::span<const TiedPoint> points, int sectors,
                                                const ContactLaw& law);

}  // namespace fingertip::lattice::inline contact
