/// The contact of MuJoCo's rigid bodies: a force of one penetration, whatever the bodies' shapes.
///
/// Its constraint of impedance d, reference acceleration -k r (direct `solref` = (-k, -b)) and
/// regularisation R = (1 - d)/d A, where A is the inverse mass along the normal, pushes at rest
/// with
///
///     F(r) = k/A r d²/(dmax² (1 - d)),   d = dmin + y(r/width) (dmax - dmin)
///
/// with y a power of `power` from 0 to 1 on both sides of `midpoint` (MuJoCo's documentation,
/// "Modeling: solver parameters"). K = k/A is a stiffness in N/m that no longer depends on masses.
#pragma once

#include "calibration/contact_laws/pressure_law.h"

namespace fingertip::calibration::inline contact_laws {

struct SoftContact {
  double stiffness = 0.0;              ///< K [N/m]
  double dmin = 0.1, dmax = 0.9;       ///< `solimp`, 0.0001 ... 0.9999
  double width = 1e-3;                 ///< [m], > 0
  double midpoint = 0.5, power = 2.0;  ///< 0.0001 ... 0.9999, >= 1

  double impedance(double penetration) const;  ///< d
  double force(double penetration) const;      ///< [N] at rest; 0 where there is no overlap
};

/// The contact whose relative errors of force on the curve have the least sum of squares;
/// impedances grow to a penetration a fifth beyond the last sample. Throws InvalidInput unless the
/// curve has two samples or more, increasing and positive.
SoftContact fitted_soft_contact(const ForceCurve& curve);

}  // namespace fingertip::calibration::inline contact_laws
