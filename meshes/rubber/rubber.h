/// Isotropic rubber, given by Young's and shear modulus as in the paper (section II.E), and at
/// large strain by a law of them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "meshes/base/errors.h"
#include "meshes/rubber/relaxation.h"
#include "meshes/rubber/strain_energy.h"

namespace fingertip::meshes::inline rubber {

/// SI units. Valid for E > 0, G > E/3 (equivalently -1 < nu < 1/2), rho > 0, tau >= 0.
struct Rubber {
  double youngs_modulus = 3922.66;   ///< E [Pa]; default 40 gf/cm²
  double shear_modulus = 1372.931;   ///< G [Pa]; default 14 gf/cm²
  double density = 500.0;            ///< rho [kg/m³]
  double retardation_time = 0.3e-3;  ///< tau of the Kelvin-Voigt damping [s], tan d = omega tau
  StrainEnergy energy;               ///< at large strain; small strain knows E and G alone
  Relaxation relaxation;             ///< E and G are what is left of them after long times

  std::vector<Violation> violations() const;

  bool has_own_law() const { return energy != StrainEnergy(); }

  /// E and G from Lamé's constants G and lambda [Pa].
  void set_lame(double shear, double lambda) {
    youngs_modulus = shear * (3.0 * lambda + 2.0 * shear) / (lambda + shear);
    shear_modulus = shear;
  }

  double poissons_ratio() const { return youngs_modulus / (2.0 * shear_modulus) - 1.0; }
  /// K = E G / (3 (3G - E)) [Pa]
  double bulk_modulus() const {
    return youngs_modulus * shear_modulus / (3.0 * (3.0 * shear_modulus - youngs_modulus));
  }
  /// First Lamé constant, lambda = K - 2G/3 [Pa]
  double lame_lambda() const { return bulk_modulus() - 2.0 / 3.0 * shear_modulus; }
  /// d(lambda)/d(E, G), lambda = G (E - 2G)/(3G - E), dimensionless.
  Eigen::RowVector2d lambda_slopes() const;
  /// Modulus of a laterally confined layer, lambda + 2G [Pa]
  double longitudinal_modulus() const { return lame_lambda() + 2.0 * shear_modulus; }
  /// c_p = sqrt((lambda + 2G)/rho) [m/s]
  double longitudinal_wave_speed() const;
  /// c_s = sqrt(G/rho) [m/s]
  double shear_wave_speed() const;
};

}  // namespace fingertip::meshes::inline rubber
