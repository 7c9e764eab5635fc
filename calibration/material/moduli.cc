#include "calibration/material/moduli.h"

namespace fingertip::calibration::inline material {

namespace {

/// l²m² + m²n² + n²l² of a direction of any length: 0 along a cube axis, 1/3 along a body diagonal.
double off_axis(const Eigen::Vector3d& direction) {
  const Eigen::Array3d squares = direction.normalized().array().square();
  return squares(0) * squares(1) + squares(1) * squares(2) + squares(2) * squares(0);
}

}  // namespace

ElasticModuli moduli_from_stiffness(double c11, double c12, double c44) {
  // Compliances of a cubic crystal; 1/E along a direction mixes S11 with the off-axis term.
  const double determinant = (c11 - c12) * (c11 + 2.0 * c12);
  ElasticModuli moduli;
  moduli.c11 = c11;
  moduli.c12 = c12;
  moduli.c44 = c44;
  moduli.youngs_modulus_100 = determinant / (c11 + c12);
  moduli.shear_modulus = c44;
  moduli.poissons_ratio_100 = c12 / (c11 + c12);
  moduli.bulk_modulus = (c11 + 2.0 * c12) / 3.0;
  moduli.anisotropy = 2.0 * c44 / (c11 - c12);
  moduli.youngs_modulus_110 = youngs_modulus_along(moduli, {1.0, 1.0, 0.0});
  moduli.youngs_modulus_111 = youngs_modulus_along(moduli, {1.0, 1.0, 1.0});
  return moduli;
}

double youngs_modulus_along(const ElasticModuli& moduli, const Eigen::Vector3d& direction) {
  const double determinant = (moduli.c11 - moduli.c12) * (moduli.c11 + 2.0 * moduli.c12);
  const double s11 = (moduli.c11 + moduli.c12) / determinant;
  const double s12 = -moduli.c12 / determinant;
  const double s44 = 1.0 / moduli.c44;
  return 1.0 / (s11 - 2.0 * (s11 - s12 - 0.5 * s44) * off_axis(direction));
}

ElasticModuli homogenised_moduli(const lattice::SpringConstants& constants, double spacing) {
  const auto& [k1, k2, k3, kappa] = constants;
  const double c44 = (k2 + 4.0 / 3.0 * k3) / spacing;
  return moduli_from_stiffness((k1 + 2.0 * k2 + 4.0 / 3.0 * k3) / spacing + kappa, c44 + kappa,
                               c44);
}

}  // namespace fingertip::calibration::inline material
