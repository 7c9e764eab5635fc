/// The material parameters that a static press can be differentiated by.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "lattice/press/press_setup.h"
#include "lattice/statics/lattice_body.h"
#include "meshes/base/names.h"

namespace fingertip::lattice::inline press {

/// Every energy of a cut tip is linear in them, its ties included, which are proportional to
/// C44 = (k2 + 4/3 k3)/a, in the network to G, and to their factors.
enum class PressParameter {
  k1,             ///< SpringConstants [N/m]
  k2,             ///< [N/m]
  k3,             ///< [N/m]
  kappa,          ///< [Pa]
  shear_modulus,  ///< G of the network's rubber, lambda held [Pa]
  lambda,         ///< of the network's rubber, G held [Pa]
  bond,           ///< LatticeSettings::ligament_stiffness
  contact,        ///< LatticeSettings::contact_stiffness
};

using meshes::name, meshes::values;
constexpr auto names_of(PressParameter) {
  using enum PressParameter;
  return meshes::names<PressParameter>({{k1, "k1"},
                                        {k2, "k2"},
                                        {k3, "k3"},
                                        {kappa, "kappa"},
                                        {shear_modulus, "shear_modulus"},
                                        {lambda, "lambda"},
                                        {bond, "bond"},
                                        {contact, "contact"}});
}

/// What a press with these settings depends on: hookean k1, k2, k3, kappa, central without kappa,
/// network shear_modulus and lambda, all of them bond and contact. Empty for the published lattice,
/// which snaps through where an equilibrium ends.
std::vector<PressParameter> press_parameters(const LatticeSettings& settings);

/// Directions in the space of the parameters, a column each.
struct PressDirections {
  std::vector<PressParameter> parameters;
  Eigen::MatrixXd rates;  ///< d(parameters)/d(way in a direction), a row per parameter

  PressDirections() = default;
  /// Along each of them by itself.
  PressDirections(std::vector<PressParameter> each);
  PressDirections(std::vector<PressParameter> parameters, Eigen::MatrixXd rates);
};

/// Of G and lambda: the constants of hookean by rule (lattice::hookean_constants) and those of the
/// network follow from the rubber's moduli. Empty: those of the model do not.
PressDirections lame_directions(const LatticeSettings& settings);

/// Value in a setup, in the parameter's unit.
double value_of(PressParameter parameter, const PressSetup& setup);

/// Changes one parameter alone. With G or lambda, E = G (3 lambda + 2 G)/(lambda + G) follows.
void set_value(PressParameter parameter, double value, PressSetup& setup);

/// dE/dp at a held displacement, where p goes in a direction, is the energy of a body, too: of the
/// one returned. Its particles and outer points are those of `body`, which is static_body of
/// `setup` in any number of sectors; its stiffnesses are derivatives with respect to p, so forces
/// come in N per unit of p. What does not depend on p is left out, save outer points, whose
/// stiffness is then zero; springs that `body` does not have because p = 0 are there. Throws
/// InvalidInput for a parameter that is not among press_parameters.
LatticeBody body_slope(const LatticeBody& body, const PressSetup& setup,
                       const PressDirections& directions, Eigen::Index direction = 0);

}  // namespace fingertip::lattice::inline press
