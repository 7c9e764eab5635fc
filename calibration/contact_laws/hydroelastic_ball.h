/// A ball of Drake's hydroelastic contact (R. Elandt et al., IROS 2019): within it is a pressure
/// that grows to its centre; a rigid body takes the pressure on its surface.
#pragma once

#include "calibration/contact_laws/pressure_law.h"

namespace fingertip::calibration::inline contact_laws {

/// p = modulus (1 - r/radius), r from the centre.
struct HydroelasticBall {
  double modulus = 0.0;  ///< Drake's `hydroelastic_modulus` [Pa]
  double radius = 0.0;   ///< [m]

  /// Of a rigid obstacle whose top is behind the pole by `indentation` [m], along the axis [N]: the
  /// integral of p over its surface in the ball, projected. On a plane 2π modulus (a²/2 - (R³ -
  /// h³)/ (3R)), h = R - delta, a² = R² - h².
  double force(const meshes::Obstacle& obstacle, double indentation) const;
};

/// Of the modulus whose relative errors of force have the least sum of squares. Throws InvalidInput
/// unless the curve has two samples or more, increasing and positive.
HydroelasticBall fitted_hydroelastic_ball(const ForceCurve& curve, const meshes::Obstacle& obstacle,
                                          double radius);

}  // namespace fingertip::calibration::inline contact_laws
