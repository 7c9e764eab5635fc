#include "lattice/cells/recipe.h"

#include <cmath>

#include "meshes/files.h"

namespace fingertip::lattice {

using meshes::Rubber;
using meshes::Violation;

namespace {

/// C by homogenisation of springs and volume constant: C12 = C44 + kappa.
CellMaterial cubic_material(const SpringConstants& k, double spacing, double shear) {
  CellMaterial material;
  material.kind = CellLawKind::cubic;
  material.c11 = (k.k1 + k.k2) / spacing + shear + k.kappa;
  material.c12 = shear + k.kappa;
  material.c44 = shear;
  material.bending = fibre_share * shear;
  return material;
}

CellMaterial network_material(const Rubber& rubber) {
  CellMaterial material;
  material.kind = CellLawKind::network;
  material.shear = rubber.shear_modulus;
  material.lambda = rubber.lame_lambda();
  material.bending = fibre_share * rubber.shear_modulus;
  return material;
}

/// kappa alone: kappa/2 (tr H)² or kappa/2 (J - 1)².
CellMaterial volume_material(double kappa, bool finite) {
  CellMaterial material;
  material.kind = finite ? CellLawKind::volume : CellLawKind::cubic;
  material.kappa = kappa;
  material.c11 = material.c12 = kappa;
  return material;
}

}  // namespace

Recipe recipe_for(const Rubber& rubber, const LatticeSettings& settings) {
  const double a = settings.spacing;
  Recipe recipe;
  recipe.finite = settings.kinematics == Kinematics::finite;
  recipe.constants =
      settings.model == ModelKind::network ? hookean_constants(rubber, a) : settings.constants;
  if (settings.model == ModelKind::central) recipe.constants.kappa = 0.0;
  recipe.shear = shear_stiffness(recipe.constants, a);
  const bool network = settings.model == ModelKind::network;
  recipe.central_springs = settings.model == ModelKind::central || (recipe.finite && !network);
  recipe.cell_law = settings.model != ModelKind::central;
  if (network && recipe.finite) {
    recipe.material = network_material(rubber);
  } else if (recipe.central_springs) {
    recipe.material = volume_material(recipe.constants.kappa, recipe.finite);
  } else {
    recipe.material = cubic_material(recipe.constants, a, recipe.shear);
  }
  recipe.material.retardation_time = rubber.retardation_time;
  return recipe;
}

Recipe spring_recipe(ModelKind kind, Kinematics kinematics, const SpringConstants& constants,
                     double retardation_time) {
  Recipe recipe;
  recipe.finite = kinematics == Kinematics::finite;
  recipe.constants = constants;
  recipe.central_springs = true;
  recipe.cell_law = kind == ModelKind::hookean && constants.kappa != 0.0;
  if (!recipe.cell_law) recipe.constants.kappa = 0.0;
  recipe.material = volume_material(recipe.constants.kappa, recipe.finite);
  recipe.material.retardation_time = retardation_time;
  return recipe;
}

std::vector<Violation> material_violations(const Rubber& rubber, const LatticeSettings& settings) {
  std::vector<Violation> found = rubber.violations();
  if (settings.model == ModelKind::published) {
    found.push_back({"lattice.model", "published", "the published lattice has no cells to cut",
                     "choose central, hookean or network"});
  }
  if (settings.model == ModelKind::network) {
    // The margin keeps round-off in other units than the user's from refusing nu = 0.
    if (settings.kinematics == Kinematics::finite && rubber.poissons_ratio() < -1e-12) {
      found.push_back({"rubber.youngs_modulus", meshes::to_text(rubber.youngs_modulus) + " Pa",
                       "the network at finite strain needs nu >= 0, that is E >= 2G: with a "
                       "negative Lame constant lambda the energy falls without bound as J -> 0",
                       "raise youngs_modulus to 2 shear_modulus or more, or take kinematics "
                       "small"});
    }
    return found;
  }
  const SpringConstants& k = settings.constants;
  const auto not_negative = [](double value) { return std::isfinite(value) && value >= 0.0; };
  if (!(not_negative(k.k1) && not_negative(k.k2) && not_negative(k.k3) && k.k2 + k.k3 > 0.0 &&
        std::isfinite(k.kappa))) {
    found.push_back({"lattice.constants",
                     "k1 " + meshes::to_text(k.k1) + ", k2 " + meshes::to_text(k.k2) + ", k3 " +
                         meshes::to_text(k.k3) + " N/m",
                     "spring constants must be finite and not negative, and some diagonal must "
                     "resist shear",
                     "use the model's closed form or a calibration"});
  }
  return found;
}

}  // namespace fingertip::lattice
