/// Elastic constants of a cubic spring lattice.
#pragma once

#include <Eigen/Core>

#include "calibration/files/moduli_file.h"
#include "lattice/model/constants.h"

namespace fingertip::calibration::inline material {

/// The engineering constants of a cubic material; SI.
struct ElasticModuli : AchievedEntry {
  double c11 = 0.0, c12 = 0.0, c44 = 0.0;  ///< stiffness in Voigt's notation [Pa]
};

/// The engineering constants that follow from C11, C12, C44 (Nye, Physical Properties of
/// Crystals, ch. VIII).
ElasticModuli moduli_from_stiffness(double c11, double c12, double c44);

/// Young's modulus [Pa] of a cubic material along `direction` (any length):
/// 1/E = S11 - 2 (S11 - S12 - S44/2)(l²m² + m²n² + n²l²).
double youngs_modulus_along(const ElasticModuli& moduli, const Eigen::Vector3d& direction);

/// Homogenised constants of the infinite lattice [derived in README]:
///   C11 = (k1 + 2 k2 + 4/3 k3)/a + kappa,  C12 = (k2 + 4/3 k3)/a + kappa,  C44 = (k2 + 4/3 k3)/a.
/// `spacing` a > 0 [m].
ElasticModuli homogenised_moduli(const lattice::SpringConstants& constants, double spacing);

}  // namespace fingertip::calibration::inline material
