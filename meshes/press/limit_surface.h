/// What a pressed patch holds by Coulomb friction, from its own pressure: the force and the moment
/// about its normal at which it slides as a whole.
#pragma once

#include <span>
#include <vector>

#include "meshes/press/contact_field.h"

namespace fingertip::meshes::inline press {

/// Per unit of the coefficient of friction; the patch turns about a place beside its centre.
struct LimitPoint {
  double away = 0.0;  ///< of that place from the centre of pressure [m]; infinite: it does not turn
  double force = 0.0;   ///< in the plane [N]
  double moment = 0.0;  ///< about the centre of pressure [N m]
};

/// Howe and Cutkosky (Int. J. Robotics Research 15, 1996): a rigid motion along the plane turns
/// about an instantaneous centre, and every point rubs against it with mu p dA.
struct LimitSurface {
  double normal_force = unknown;     ///< N [N]
  double radius = unknown;           ///< a, of the circle with the contact's area [m]
  double greatest_moment = unknown;  ///< Σ r p A, turning about the centre of pressure [N m]
  std::vector<LimitPoint> points;    ///< by increasing distance, 0 and infinity among them
  /// How far the ellipse through both ends, F² / N² + M² / greatest_moment² = 1, lies outside at
  /// most; negative where it lies inside.
  double ellipse_error = unknown;
  /// k of p ∝ (1 - (r/a)^k)^(1/k) (Xydas and Kao, 1999), 0.5 to 40: 2 is Hertz, more is flatter. Of
  /// the pressure's mean r² over that of r squared; unknown where no such k has it, as of a contact
  /// that is not round.
  double exponent = unknown;

  /// Greatest moment over N a: 3 pi/16 of Hertz.
  double moment_share() const { return greatest_moment / (normal_force * radius); }
};

/// Of a sample's field, seen along n. `direction` [rad]: of the centres from that of pressure, from
/// t1 toward t2. Without a field that pushes all stays unknown.
LimitSurface limit_surface(std::span<const ContactPoint> field, double direction = 0.0);

/// At one distance of the place [m].
LimitPoint limit_point(std::span<const ContactPoint> field, double away, double direction = 0.0);

/// a = c N^gamma through contact radii [m] at normal forces [N], by least squares of logarithms
/// (Xydas and Kao: 0 <= gamma <= 1/3); unknown of fewer than two.
struct RadiusLaw {
  double factor = unknown;  ///< c [m/N^gamma]
  double gamma = unknown;
};
RadiusLaw radius_law(std::span<const LimitSurface> surfaces);

}  // namespace fingertip::meshes::inline press
