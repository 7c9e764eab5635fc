/// What a lattice of cells is made of: central springs, or cells with a law and fibres.
#pragma once

#include <vector>

#include "lattice/model/cell_lattice.h"
#include "lattice/model/constants.h"
#include "lattice/model/lattice_settings.h"
#include "meshes/base/errors.h"
#include "meshes/rubber/rubber.h"

namespace fingertip::lattice::inline model {

/// Share s of the shear energy that is carried by the fibres along the cells' edges; the rest sees
/// the cell's mean gradient. With s = 1/3 the bilinear modes of a cell cost what they cost in the
/// continuum (edges see y² = 1/4 where the mean over the cell is 1/12).
inline constexpr double fibre_share = 1.0 / 3.0;

///   hookean, small    isotropic fibres s C44 a along the edges, cells with the law `cubic`
///   network, finite   isotropic fibres s G a, cells with the law of Rubber::energy (`network` for
///                     the usual one); no stress at rest in cut cells either
///   network, small    hookean with the rubber's closed form for its constants
///   hookean, finite   central springs k1, k2, k3, cells with the law `volume`
///   central           central springs k1, k2, k3, cells without a law
struct Formulation {
  SpringConstants constants;     ///< of this lattice; kappa = 0 for central
  bool central_springs = false;  ///< whether k1, k2, k3 are springs
  bool cell_law = false;         ///< whether cells store energy
  CellMaterial material;  ///< of the cells; its `hourglass_modulus` times a is a whole edge's fibre
  bool finite = false;    ///< kinematics
  meshes::Relaxation relaxation;  ///< of all constants, or of shear alone
  double shear = 0.0;             ///< C44 at rest [Pa]
};

/// C by homogenisation of springs and volume constant: C12 = C44 + kappa, C11 = (k1 + 2 k2 + 4/3
/// k3)/a + kappa, C44 = (k2 + 4/3 k3)/a; fibres carry the share `share` of C44. `spacing` a > 0
/// [m].
CellMaterial cubic_material(const SpringConstants& constants, double spacing, double share);
/// kappa alone [Pa]: kappa/2 (tr H)² or kappa/2 (J - 1)².
CellMaterial volume_material(double kappa, bool finite);
/// `shear` G and `lambda` at rest [Pa]; fibres carry the share `share` of G. What makes the energy
/// unbounded (meshes::large_strain_violations) is not checked.
CellMaterial network_material(const meshes::StrainEnergy& energy, double shear, double lambda,
                              double share);

/// settings.constants are those of hookean (kappa included) and central, the network takes G and
/// lambda of the rubber. Settings must be free of cell_violations.
Formulation formulation_for(const meshes::Rubber& rubber, const LatticeSettings& settings);

/// Central springs k1, k2, k3 throughout and, for hookean, cells that resist changes of volume:
/// what the constants mean one by one (calibration). `kind` is central or hookean.
Formulation spring_formulation(ModelKind kind, Kinematics kinematics,
                               const SpringConstants& constants, double retardation_time);

/// The rubber's broken rules, LatticeSettings::material_violations, the published model, and laws
/// of large strain that the model does not have.
std::vector<meshes::Violation> cell_violations(const meshes::Rubber& rubber,
                                               const LatticeSettings& settings);

}  // namespace fingertip::lattice::inline model
