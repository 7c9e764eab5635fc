#include "meshes/rubber/rubber.h"

#include <cmath>
#include <utility>

#include "meshes/base/files.h"
#include "meshes/rubber/stability.h"

namespace fingertip::meshes::inline rubber {

std::vector<Violation> Rubber::violations() const {
  std::vector<Violation> found;
  const auto require = [&](bool holds, const char* key, double value, const char* unit,
                           const char* rule, const char* remedy) {
    if (!holds) found.push_back({key, to_text(value) + " " + unit, rule, remedy});
  };
  require(std::isfinite(youngs_modulus) && youngs_modulus > 0.0, "rubber.youngs_modulus",
          youngs_modulus, "Pa", "E must be finite and positive", "give Young's modulus");
  require(std::isfinite(shear_modulus) && shear_modulus > 0.0, "rubber.shear_modulus",
          shear_modulus, "Pa", "G must be finite and positive", "give the shear modulus");
  // The margin keeps round-off (E = 42, G = 14 gf/cm²) from letting nu = 1/2 pass.
  require(!(shear_modulus <= youngs_modulus / 3.0 * (1.0 + 1e-12)), "rubber.shear_modulus",
          shear_modulus, "Pa",
          "G must exceed E/3, or Poisson's ratio E/(2G) - 1 reaches 1/2 and the bulk modulus is "
          "infinite or negative",
          "raise shear_modulus above youngs_modulus/3, or lower youngs_modulus");
  require(!(youngs_modulus > 0.0 && youngs_modulus <= 1e-12 * shear_modulus),
          "rubber.youngs_modulus", youngs_modulus, "Pa",
          "E must not vanish beside G, or Poisson's ratio E/(2G) - 1 reaches -1",
          "raise youngs_modulus, or lower shear_modulus");
  require(std::isfinite(density) && density > 0.0, "rubber.density", density, "kg/m^3",
          "rho must be finite and positive", "give the rubber's density");
  require(std::isfinite(retardation_time) && retardation_time >= 0.0, "rubber.retardation_time",
          retardation_time, "s", "tau must be finite and not negative",
          "give the Kelvin-Voigt retardation time, or 0 for no damping");
  append(found, meshes::violations(energy));
  append(found, relaxation.violations());
  return found;
}

Eigen::RowVector2d Rubber::lambda_slopes() const {
  const double e = youngs_modulus, g = shear_modulus;
  return Eigen::RowVector2d(g * g, 4.0 * e * g - e * e - 6.0 * g * g) /
         ((3.0 * g - e) * (3.0 * g - e));
}

double Rubber::longitudinal_wave_speed() const {
  return std::sqrt(longitudinal_modulus() / density);
}

double Rubber::shear_wave_speed() const {
  return std::sqrt(shear_modulus / density);
}

}  // namespace fingertip::meshes::inline rubber
