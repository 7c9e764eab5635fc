#include "lattice/model/formulation.h"

#include <string>

#include "meshes/rubber/hyperelastic_law.h"

namespace fingertip::lattice::inline model {

using meshes::Rubber;
using meshes::Violation;

CellMaterial cubic_material(const SpringConstants& k, double spacing, double share) {
  CellMaterial material;
  material.kind = CellLawKind::cubic;
  material.c44 = shear_stiffness(k, spacing);
  material.c12 = material.c44 + k.kappa;
  material.c11 = (k.k1 + k.k2) / spacing + material.c44 + k.kappa;
  material.hourglass_modulus = share * material.c44;
  return material;
}

CellMaterial volume_material(double kappa, bool finite) {
  CellMaterial material;
  material.kind = finite ? CellLawKind::volume : CellLawKind::cubic;
  material.kappa = kappa;
  material.c11 = material.c12 = kappa;
  return material;
}

CellMaterial network_material(const meshes::StrainEnergy& energy, double shear, double lambda,
                              double share) {
  CellMaterial material;
  material.kind =
      energy == meshes::StrainEnergy() ? CellLawKind::network : CellLawKind::hyperelastic;
  material.energy = energy;
  material.volumetric =
      energy.isochoric() ? lambda + 2.0 / 3.0 * shear : lambda - energy.lambda_share() * shear;
  material.shear = shear;
  material.lambda = lambda;
  material.hourglass_modulus = share * shear;
  return material;
}

Formulation formulation_for(const Rubber& rubber, const LatticeSettings& settings) {
  const double a = settings.spacing;
  Formulation formulation;
  formulation.finite = settings.kinematics == Kinematics::finite;
  formulation.constants =
      settings.model == ModelKind::network ? hookean_constants(rubber, a) : settings.constants;
  if (settings.model == ModelKind::central) formulation.constants.kappa = 0.0;
  formulation.shear = shear_stiffness(formulation.constants, a);
  const bool network = settings.model == ModelKind::network;
  formulation.central_springs =
      settings.model == ModelKind::central || (formulation.finite && !network);
  formulation.cell_law = settings.model != ModelKind::central;
  if (network && formulation.finite) {
    formulation.material =
        network_material(rubber.energy, rubber.shear_modulus, rubber.lame_lambda(), fibre_share);
  } else if (formulation.central_springs) {
    formulation.material = volume_material(formulation.constants.kappa, formulation.finite);
  } else {
    formulation.material = cubic_material(formulation.constants, a, fibre_share);
  }
  formulation.material.retardation_time = rubber.retardation_time;
  formulation.relaxation = rubber.relaxation;
  return formulation;
}

Formulation spring_formulation(ModelKind kind, Kinematics kinematics,
                               const SpringConstants& constants, double retardation_time) {
  Formulation formulation;
  formulation.finite = kinematics == Kinematics::finite;
  formulation.constants = constants;
  formulation.central_springs = true;
  formulation.cell_law = kind == ModelKind::hookean && constants.kappa != 0.0;
  if (!formulation.cell_law) formulation.constants.kappa = 0.0;
  formulation.material = volume_material(formulation.constants.kappa, formulation.finite);
  formulation.material.retardation_time = retardation_time;
  return formulation;
}

std::vector<Violation> cell_violations(const Rubber& rubber, const LatticeSettings& settings) {
  std::vector<Violation> found = rubber.violations();
  append(found, settings.material_violations(rubber));
  if (settings.model == ModelKind::published) {
    found.push_back({"lattice.model", "published", "the published lattice has no cells to cut",
                     "choose central, hookean or network"});
  } else if (settings.kinematics == Kinematics::small) {
    return found;
  } else if (settings.model == ModelKind::network) {
    return found.empty() ? meshes::large_strain_violations(rubber) : found;
  } else if (rubber.energy.law != meshes::StrainEnergy().law) {
    found.push_back({"rubber.law", std::string(meshes::name(rubber.energy.law)),
                     "at finite kinematics a lattice of model " +
                         std::string(name(settings.model)) + " has no law of large strain",
                     "take lattice.model = \"network\", or kinematics = \"small\""});
  }
  return found;
}

}  // namespace fingertip::lattice::inline model
