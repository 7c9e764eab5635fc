/// Elastic sphere pressed on a rigid frictionless plane (Hertz 1882).
#pragma once

#include "meshes/rubber/rubber.h"

namespace fingertip::fem_reference::analytic {

/// The sphere is replaced by a half-space with a parabolic gap r²/(2R), E* = E/(1 - nu²):
///   a = sqrt(R delta),  F = 4/3 E* sqrt(R) delta^(3/2),
///   p(r) = p_0 sqrt(1 - r²/a²),  p_0 = 2 E* a/(pi R) = 3 F/(2 pi a²).
/// Source: K. L. Johnson, Contact Mechanics (1985), sections 3.4 and 4.2.
///
/// Where it holds: a << R and a << every other length of the body. On a solid hemisphere the force
/// exceeds the formula by an amount proportional to sqrt(delta/R), and the formula is good only up
/// to delta = 2e-4 R; the tip bonded to its rod is 16 % stiffer at 0.01 R already (project
/// figures). No range is enforced: how far the formula may be trusted is the caller's question.
class Hertz {
 public:
  /// `radius` R [m] > 0. Throws meshes::InvalidInput for an invalid rubber or radius.
  Hertz(const meshes::Rubber& rubber, double radius);

  // All take an indentation delta >= 0 [m] and throw meshes::InvalidInput for any other.

  /// F [N]
  double force(double indentation) const;
  /// a [m]
  double contact_radius(double indentation) const;
  /// p_0, in the middle [Pa]
  double max_pressure(double indentation) const;
  /// p at distance r >= 0 [m] from the axis, 0 outside the contact [Pa]
  double pressure(double r, double indentation) const;
  /// delta [m] at force F >= 0 [N]
  double indentation_at_force(double force) const;

 private:
  double modulus_;  ///< E*
  double radius_;   ///< R
};

}  // namespace fingertip::fem_reference::analytic
