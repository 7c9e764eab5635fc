#include "lattice/model/formulation.h"

#include <cmath>
#include <string>

#include "meshes/base/files.h"
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

std::vector<Violation> material_violations(const Rubber& rubber, const LatticeSettings& settings) {
  std::vector<Violation> found = rubber.violations();
  if (settings.model == ModelKind::published) {
    found.push_back({"lattice.model", "published", "the published lattice has no cells to cut",
                     "choose central, hookean or network"});
  }
  if (settings.model == ModelKind::network) {
    if (settings.kinematics == Kinematics::finite && found.empty())
      return meshes::large_strain_violations(rubber);
    return found;
  }
  const meshes::StrainEnergy usual;
  if (settings.kinematics == Kinematics::finite && rubber.energy.law != usual.law) {
    found.push_back({"rubber.law", std::string(meshes::name(rubber.energy.law)),
                     "at finite kinematics a lattice of model " +
                         std::string(name(settings.model)) + " has no law of large strain",
                     "take lattice.model = \"network\", or kinematics = \"small\""});
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

}  // namespace fingertip::lattice::inline model
