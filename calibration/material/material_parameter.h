/// What a fit may seek: the constants of a rubber, of its lattice and of the machine that presses
/// it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>
#include <vector>

#include "meshes/rubber/rubber.h"

namespace fingertip::calibration::inline material {

/// What can be identified. Of a rubber's two constants one is varied while the named
/// other is held, so E and G go together, and G with lambda.
enum class MaterialParameter {
  youngs_modulus,    ///< E, G held [Pa]
  shear_modulus,     ///< G, E held [Pa]
  modulus,           ///< E, Poisson's ratio held [Pa]
  k1,                ///< SpringConstants [N/m]
  k2,                ///< [N/m]
  k3,                ///< [N/m]
  kappa,             ///< [Pa]
  lame_shear,        ///< G, lambda held; network [Pa]
  lambda,            ///< G held; network [Pa]
  bond,              ///< LatticeSettings::ligament_stiffness
  contact,           ///< LatticeSettings::contact_stiffness
  retardation_time,  ///< tau of Kelvin and Voigt [s]
  // Coefficients of laws at large strain, meshes/rubber/strain_energy.h; material_tests/ fits them.
  yeoh_c1,       ///< [Pa]
  yeoh_c2,       ///< [Pa]
  yeoh_c3,       ///< [Pa]
  mooney_c10,    ///< [Pa]
  mooney_c01,    ///< [Pa]
  ogden_mu1,     ///< mu_1 [Pa]
  ogden_alpha1,  ///< its exponent
  ogden_mu2,     ///< [Pa]
  ogden_alpha2,
  ogden_mu3,  ///< [Pa]
  ogden_alpha3,
  gent_jm,       ///< largest I1 - 3
  bulk_modulus,  ///< K, all else held [Pa]
  // Branches of meshes/rubber/relaxation.h, the moduli after long times held.
  relaxation_g1,    ///< share of G0
  relaxation_tau1,  ///< [s]
  relaxation_g2,
  relaxation_tau2,
  relaxation_g3,
  relaxation_tau3,
  relaxation_g4,
  relaxation_tau4,
  relaxation_g5,
  relaxation_tau5,
  // What a machine tells of a specimen at rest, material_tests/law_zeros.h.
  stress_zero,  ///< [Pa]
  strain_zero,
  // What a machine adds, rig_model.h.
  touch_offset,  ///< travel at first touch [m]
  compliance,    ///< of the machine [m/N]
  force_offset,  ///< what the load cell tells without a load [N]
  drift,         ///< by how much that changes in time [N/s]
};

/// What it may be by nature. What is positive is sought by its logarithm.
enum class Sign { positive, not_negative, any };

struct ParameterKind {
  std::string_view name;  ///< the enumerator's
  std::string_view unit;  ///< "Pa", "N/m", "s", "m", "m/N", "N", "N/s" or "1"
  Sign sign;
};
const ParameterKind& kind(MaterialParameter parameter);

inline std::string_view name(MaterialParameter parameter) {
  return kind(parameter).name;
}
inline std::string_view unit(MaterialParameter parameter) {
  return kind(parameter).unit;
}

/// What belongs to a machine or to one of its files.
inline constexpr std::array rig_parameters{
    MaterialParameter::touch_offset, MaterialParameter::compliance, MaterialParameter::force_offset,
    MaterialParameter::drift};
bool is_of_the_rig(MaterialParameter parameter);

/// Share and time of the branches of a relaxation, branch by branch.
inline constexpr std::array relaxation_parameters{
    MaterialParameter::relaxation_g1, MaterialParameter::relaxation_tau1,
    MaterialParameter::relaxation_g2, MaterialParameter::relaxation_tau2,
    MaterialParameter::relaxation_g3, MaterialParameter::relaxation_tau3,
    MaterialParameter::relaxation_g4, MaterialParameter::relaxation_tau4,
    MaterialParameter::relaxation_g5, MaterialParameter::relaxation_tau5};
bool is_of_the_relaxation(MaterialParameter parameter);

/// What makes of an elastic press what a machine tells: of the rig or of the relaxation. In a list
/// of free parameters it stands behind what the press depends on.
bool is_behind_the_press(MaterialParameter parameter);

/// E, G and modulus: what describes a rubber by its engineering moduli.
bool is_modulus(MaterialParameter parameter);

/// Moduli, lame_shear and lambda: what a continuum depends on, too.
bool is_of_the_rubber(MaterialParameter parameter);

/// `rubber` with the moduli, lame_shear and lambda among `parameters` set to their values; others
/// are passed over.
meshes::Rubber with_moduli(meshes::Rubber rubber, const std::vector<MaterialParameter>& parameters,
                           const Eigen::VectorXd& values);

/// d(E, G)/d(parameter) of a modulus, lame_shear or lambda at the rubber's Poisson's ratio,
/// dimensionless.
Eigen::Vector2d moduli_slopes(MaterialParameter parameter, double poissons_ratio);

}  // namespace fingertip::calibration::inline material
