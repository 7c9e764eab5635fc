#include "calibration/material/material_parameter.h"

#include <algorithm>

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

std::string_view name(MaterialParameter parameter) {
  switch (parameter) {
    case MaterialParameter::youngs_modulus: return "youngs_modulus";
    case MaterialParameter::shear_modulus: return "shear_modulus";
    case MaterialParameter::modulus: return "modulus";
    case MaterialParameter::k1: return "k1";
    case MaterialParameter::k2: return "k2";
    case MaterialParameter::k3: return "k3";
    case MaterialParameter::kappa: return "kappa";
    case MaterialParameter::lame_shear: return "lame_shear";
    case MaterialParameter::lambda: return "lambda";
    case MaterialParameter::bond: return "bond";
    case MaterialParameter::contact: return "contact";
    case MaterialParameter::retardation_time: return "retardation_time";
    case MaterialParameter::yeoh_c1: return "yeoh_c1";
    case MaterialParameter::yeoh_c2: return "yeoh_c2";
    case MaterialParameter::yeoh_c3: return "yeoh_c3";
    case MaterialParameter::mooney_c10: return "mooney_c10";
    case MaterialParameter::mooney_c01: return "mooney_c01";
    case MaterialParameter::ogden_mu1: return "ogden_mu1";
    case MaterialParameter::ogden_alpha1: return "ogden_alpha1";
    case MaterialParameter::ogden_mu2: return "ogden_mu2";
    case MaterialParameter::ogden_alpha2: return "ogden_alpha2";
    case MaterialParameter::ogden_mu3: return "ogden_mu3";
    case MaterialParameter::ogden_alpha3: return "ogden_alpha3";
    case MaterialParameter::gent_jm: return "gent_jm";
    case MaterialParameter::bulk_modulus: return "bulk_modulus";
    case MaterialParameter::relaxation_g1: return "relaxation_g1";
    case MaterialParameter::relaxation_tau1: return "relaxation_tau1";
    case MaterialParameter::relaxation_g2: return "relaxation_g2";
    case MaterialParameter::relaxation_tau2: return "relaxation_tau2";
    case MaterialParameter::relaxation_g3: return "relaxation_g3";
    case MaterialParameter::relaxation_tau3: return "relaxation_tau3";
    case MaterialParameter::relaxation_g4: return "relaxation_g4";
    case MaterialParameter::relaxation_tau4: return "relaxation_tau4";
    case MaterialParameter::relaxation_g5: return "relaxation_g5";
    case MaterialParameter::relaxation_tau5: return "relaxation_tau5";
    case MaterialParameter::touch_offset: return "touch_offset";
    case MaterialParameter::compliance: return "compliance";
    case MaterialParameter::force_offset: return "force_offset";
    case MaterialParameter::drift: return "drift";
  }
  return "unknown";
}

std::string_view unit(MaterialParameter parameter) {
  switch (parameter) {
    case MaterialParameter::k1:
    case MaterialParameter::k2:
    case MaterialParameter::k3: return "N/m";
    case MaterialParameter::bond:
    case MaterialParameter::contact:
    case MaterialParameter::ogden_alpha1:
    case MaterialParameter::ogden_alpha2:
    case MaterialParameter::ogden_alpha3:
    case MaterialParameter::gent_jm:
    case MaterialParameter::relaxation_g1:
    case MaterialParameter::relaxation_g2:
    case MaterialParameter::relaxation_g3:
    case MaterialParameter::relaxation_g4:
    case MaterialParameter::relaxation_g5: return "1";
    case MaterialParameter::retardation_time:
    case MaterialParameter::relaxation_tau1:
    case MaterialParameter::relaxation_tau2:
    case MaterialParameter::relaxation_tau3:
    case MaterialParameter::relaxation_tau4:
    case MaterialParameter::relaxation_tau5: return "s";
    case MaterialParameter::touch_offset: return "m";
    case MaterialParameter::compliance: return "m/N";
    case MaterialParameter::force_offset: return "N";
    case MaterialParameter::drift: return "N/s";
    default: return "Pa";
  }
}

Eigen::RowVector2d lambda_slopes(double e, double g) {
  const double denominator = (3.0 * g - e) * (3.0 * g - e);
  return Eigen::RowVector2d(g * g, 4.0 * e * g - e * e - 6.0 * g * g) / denominator;
}

}  // namespace fingertip::calibration::inline material
