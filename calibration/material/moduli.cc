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

Eigen::RowVector3d youngs_modulus_slopes(const ElasticModuli& moduli,
                                         const Eigen::Vector3d& direction) {
  const double q = off_axis(direction), e = youngs_modulus_along(moduli, direction);
  const double shear = moduli.c11 - moduli.c12, bulk = moduli.c11 + 2.0 * moduli.c12;
  const double by_shear = (2.0 / 3.0 - 2.0 * q) / (shear * shear);
  const double by_bulk = 1.0 / (3.0 * bulk * bulk);
  return e * e *
         Eigen::RowVector3d(by_shear + by_bulk, 2.0 * by_bulk - by_shear,
                            q / (moduli.c44 * moduli.c44));
}

Eigen::Matrix<double, 3, 4> stiffness_jacobian(double spacing) {
  Eigen::Matrix<double, 3, 4> jacobian;
  jacobian << 1.0, 2.0, 4.0 / 3.0, spacing,  //
      0.0, 1.0, 4.0 / 3.0, spacing,          //
      0.0, 1.0, 4.0 / 3.0, 0.0;
  return jacobian / spacing;
}

ElasticModuli homogenised_moduli(const lattice::SpringConstants& constants, double spacing) {
  const Eigen::Vector4d k(constants.k1, constants.k2, constants.k3, constants.kappa);
  const Eigen::Vector3d c = stiffness_jacobian(spacing) * k;
  return moduli_from_stiffness(c(0), c(1), c(2));
}

Eigen::Matrix4d moduli_jacobian(const lattice::SpringConstants& constants, double spacing) {
  const ElasticModuli m = homogenised_moduli(constants, spacing);
  const double sum = m.c11 + m.c12;
  // nu = C12/(C11 + C12), K = (C11 + 2 C12)/3.
  Eigen::Matrix<double, 4, 3> by_stiffness;
  by_stiffness << youngs_modulus_slopes(m, Eigen::Vector3d::UnitX()),  //
      0.0, 0.0, 1.0,                                                   //
      -m.c12 / (sum * sum), m.c11 / (sum * sum), 0.0,                  //
      1.0 / 3.0, 2.0 / 3.0, 0.0;
  return by_stiffness * stiffness_jacobian(spacing);
}

}  // namespace fingertip::calibration::inline material
