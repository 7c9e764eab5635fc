#include "calibration/material/material_parameter.h"

#include <algorithm>
#include <iterator>

namespace fingertip::calibration::inline material {

bool is_modulus(MaterialParameter parameter) {
  return parameter == MaterialParameter::youngs_modulus ||
         parameter == MaterialParameter::shear_modulus || parameter == MaterialParameter::modulus;
}

bool is_of_the_rig(MaterialParameter parameter) {
  return std::ranges::find(rig_parameters, parameter) != rig_parameters.end();
}

bool is_of_the_relaxation(MaterialParameter parameter) {
  return std::ranges::find(relaxation_parameters, parameter) != relaxation_parameters.end();
}

bool is_behind_the_press(MaterialParameter parameter) {
  return is_of_the_rig(parameter) || is_of_the_relaxation(parameter);
}

bool is_of_the_rubber(MaterialParameter parameter) {
  return is_modulus(parameter) || parameter == MaterialParameter::lame_shear ||
         parameter == MaterialParameter::lambda;
}

meshes::Rubber with_moduli(meshes::Rubber rubber, const std::vector<MaterialParameter>& parameters,
                           const Eigen::VectorXd& values) {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const double value = values(Eigen::Index(i));
    switch (parameters[i]) {
      case MaterialParameter::youngs_modulus: rubber.youngs_modulus = value; break;
      case MaterialParameter::shear_modulus: rubber.shear_modulus = value; break;
      case MaterialParameter::modulus:
        rubber.shear_modulus *= value / rubber.youngs_modulus;
        rubber.youngs_modulus = value;
        break;
      case MaterialParameter::lame_shear: rubber.set_lame(value, rubber.lame_lambda()); break;
      case MaterialParameter::lambda: rubber.set_lame(rubber.shear_modulus, value); break;
      default: break;
    }
  }
  return rubber;
}

Eigen::Vector2d moduli_slopes(MaterialParameter parameter, double poissons_ratio) {
  const double nu = poissons_ratio;
  switch (parameter) {
    case MaterialParameter::youngs_modulus: return {1.0, 0.0};
    case MaterialParameter::shear_modulus: return {0.0, 1.0};
    // E = G (3 lambda + 2G)/(lambda + G) and lambda = 2 G nu/(1 - 2 nu).
    case MaterialParameter::lame_shear: return {2.0 + 4.0 * nu * nu, 1.0};
    case MaterialParameter::lambda: return {(1.0 - 2.0 * nu) * (1.0 - 2.0 * nu), 0.0};
    default: return {1.0, 0.5 / (1.0 + nu)};
  }
}

const ParameterKind& kind(MaterialParameter parameter) {
  using enum Sign;
  // In the order of the enumerators.
  static constexpr ParameterKind kinds[] = {
      {"youngs_modulus", "Pa", positive},
      {"shear_modulus", "Pa", positive},
      {"modulus", "Pa", positive},
      {"k1", "N/m", not_negative},
      {"k2", "N/m", not_negative},
      {"k3", "N/m", not_negative},
      {"kappa", "Pa", any},
      {"lame_shear", "Pa", positive},
      {"lambda", "Pa", any},
      {"bond", "1", positive},
      {"contact", "1", positive},
      {"retardation_time", "s", positive},
      {"yeoh_c1", "Pa", not_negative},
      {"yeoh_c2", "Pa", any},
      {"yeoh_c3", "Pa", any},
      {"mooney_c10", "Pa", any},
      {"mooney_c01", "Pa", any},
      {"ogden_mu1", "Pa", positive},
      {"ogden_alpha1", "1", any},
      {"ogden_mu2", "Pa", positive},
      {"ogden_alpha2", "1", any},
      {"ogden_mu3", "Pa", positive},
      {"ogden_alpha3", "1", any},
      {"gent_jm", "1", positive},
      {"bulk_modulus", "Pa", positive},
      {"relaxation_g1", "1", not_negative},
      {"relaxation_tau1", "s", positive},
      {"relaxation_g2", "1", not_negative},
      {"relaxation_tau2", "s", positive},
      {"relaxation_g3", "1", not_negative},
      {"relaxation_tau3", "s", positive},
      {"relaxation_g4", "1", not_negative},
      {"relaxation_tau4", "s", positive},
      {"relaxation_g5", "1", not_negative},
      {"relaxation_tau5", "s", positive},
      {"stress_zero", "Pa", any},
      {"strain_zero", "1", any},
      {"touch_offset", "m", any},
      {"compliance", "m/N", any},
      {"force_offset", "N", any},
      {"drift", "N/s", any},
  };
  static_assert(std::size(kinds) == std::size_t(MaterialParameter::drift) + 1);
  return kinds[std::size_t(parameter)];
}

}  // namespace fingertip::calibration::inline material
