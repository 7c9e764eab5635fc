#include "lattice/model/constants.h"

#include <cmath>

namespace fingertip::lattice::inline model {

SpringConstants published_constants(const meshes::Rubber& rubber, double spacing) {
  const double k1 = rubber.youngs_modulus * spacing;  // E a²/l0 with l0 = a
  return {k1, k1 / std::sqrt(2.0), k1 / std::sqrt(3.0), 0.0};
}

SpringConstants hookean_constants(const meshes::Rubber& rubber, double spacing, double k3) {
  const double shear = spacing * rubber.shear_modulus;
  return {shear + 4.0 / 3.0 * k3, shear - 4.0 / 3.0 * k3, k3,
          rubber.lame_lambda() - rubber.shear_modulus};
}

double shear_stiffness(const SpringConstants& constants, double spacing) {
  return (constants.k2 + 4.0 / 3.0 * constants.k3) / spacing;
}

}  // namespace fingertip::lattice::inline model
