/// From material parameters to the forces of a press and their derivatives.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <map>
#include <string_view>
#include <vector>

#include "lattice/press/press_parameters.h"
#include "lattice/press/press_setup.h"

namespace fingertip::calibration {

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
  // Coefficients of laws at large strain, meshes/strain_energy.h; material_tests/ fits them.
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
  // Branches of meshes/relaxation.h, the moduli after long times held.
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
  // What a machine adds, rig_model.h.
  touch_offset,  ///< travel at first touch [m]
  compliance,    ///< of the machine [m/N]
  force_offset,  ///< what the load cell tells without a load [N]
  drift,         ///< by how much that changes in time [N/s]
};

/// The enumerator's name.
std::string_view name(MaterialParameter parameter);

/// "Pa", "N/m", "s", "m", "m/N", "N", "N/s" or "1".
std::string_view unit(MaterialParameter parameter);

/// Value in a setup, in the parameter's unit; lame_shear and lambda are the rubber's. NaN for
/// coefficients of laws at large strain.
double value_of(MaterialParameter parameter, const lattice::PressSetup& setup);

/// What a model answers at the abscissae of a curve.
struct CurveSlopes {
  Eigen::VectorXd value;     ///< in the curve's unit; of a press forces [N]
  Eigen::MatrixXd jacobian;  ///< rows are abscissae, columns parameters [value per unit]
};

/// A curve as a function of parameters, whose order the model knows. Its abscissae are fixed.
class ForwardModel {
 public:
  virtual ~ForwardModel() = default;
  /// Throws InvalidInput for parameters outside of the model's range, NotConverged where it finds
  /// no answer, Interrupted where it is told to stop. Different models may be evaluated side by
  /// side, one model is not.
  virtual CurveSlopes evaluate(const Eigen::VectorXd& parameters) = 0;
};

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

/// lambda = G (E - 2G)/(3G - E) by E and by G, dimensionless.
Eigen::RowVector2d lambda_slopes(double youngs_modulus, double shear_modulus);

/// The static lattice: normal forces at protocol.samples by run_static_press_with_slopes.
/// E and G become constants of hookean by k1 = k2 = aG, k3 = 0, kappa = lambda - G, whatever the
/// setup's constants were, and go to the network as they are. What is not among the parameters
/// stays as in the setup. Where moduli alone are sought, forces are proportional to them at held
/// Poisson's ratio, so that a press is done once per ratio, at the setup's own G.
class LatticeForwardModel final : public ForwardModel {
 public:
  /// Throws InvalidInput for an empty list, a parameter that the setup's model does not have, one
  /// named twice, parameters that describe the rubber in two ways at once, or a lateral motion
  /// after the press. `go_on` is asked
  /// after every step of a press.
  LatticeForwardModel(lattice::PressSetup setup, std::vector<MaterialParameter> parameters,
                      std::function<bool()> go_on = {});

  /// Throws also as run_static_press_with_slopes does, Interrupted when `go_on` says no.
  CurveSlopes evaluate(const Eigen::VectorXd& parameters) override;
  /// The press with these parameters.
  lattice::PressSetup setup_with(const Eigen::VectorXd& parameters) const;

 private:
  bool by_moduli() const;
  /// d(press parameters)/d(parameters), rows as in press_parameters_.
  Eigen::MatrixXd chain(const lattice::PressSetup& setup) const;
  CurveSlopes press(const lattice::PressSetup& setup) const;
  /// At this Poisson's ratio and the setup's own G.
  const CurveSlopes& at_ratio(double poissons_ratio);

  lattice::PressSetup setup_;
  std::vector<MaterialParameter> parameters_;
  std::vector<lattice::PressParameter> press_parameters_;
  std::function<bool()> go_on_;
  std::map<double, CurveSlopes> by_ratio_;  ///< answers by Poisson's ratio, where moduli are all
};

}  // namespace fingertip::calibration
