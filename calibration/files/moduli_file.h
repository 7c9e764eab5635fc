/// calibration.json of a fit to moduli, and what fits to curves have in common with it. SI.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "meshes/tables/file_fields.h"

namespace fingertip::calibration::inline files {

/// A rubber [Pa].
struct RubberEntry {
  double youngs_modulus = meshes::unknown, shear_modulus = meshes::unknown,
         poissons_ratio = meshes::unknown, bulk_modulus = meshes::unknown;
  std::optional<std::vector<std::vector<double>>> relaxation = {};  ///< shares and times [s]
};
consteval auto fields_of(const RubberEntry*) {
  return FINGERTIP_ALL_MEMBERS(RubberEntry, youngs_modulus, shear_modulus, poissons_ratio,
                               bulk_modulus, relaxation)
      .if_known("relaxation");
}

/// Spring constants [N/m], volume constant [Pa]; of the network lambda and G besides [Pa].
struct FitConstants {
  double k1 = meshes::unknown, k2 = meshes::unknown, k3 = meshes::unknown, kappa = meshes::unknown,
         lambda = meshes::unknown, G = meshes::unknown;
};
consteval auto fields_of(const FitConstants*) {
  return FINGERTIP_ALL_MEMBERS(FitConstants, k1, k2, k3, kappa, lambda, G).if_known("lambda G");
}

/// Elastic constants of the infinite lattice [Pa].
struct AchievedEntry {
  double youngs_modulus_100 = meshes::unknown;  ///< E along a cube axis
  double youngs_modulus_110 = meshes::unknown;  ///< E along a face diagonal
  double youngs_modulus_111 = meshes::unknown;  ///< E along a body diagonal
  double shear_modulus = meshes::unknown;       ///< C44: shear of a cube face along a cube edge
  double poissons_ratio_100 =
      meshes::unknown;                    ///< lateral contraction in tension along a cube axis
  double bulk_modulus = meshes::unknown;  ///< K = (C11 + 2 C12)/3
  double anisotropy = meshes::unknown;    ///< Zener's A = 2 C44/(C11 - C12), 1 when isotropic
};
FINGERTIP_FIELDS(AchievedEntry, youngs_modulus_100, youngs_modulus_110, youngs_modulus_111,
                 shear_modulus, poissons_ratio_100, bulk_modulus, anisotropy);

/// [s].
struct DampingEntry {
  double retardation_time = meshes::unknown;
};
FINGERTIP_FIELDS(DampingEntry, retardation_time);

/// A move of the constants that no test of moduli notices.
struct OpenConstants {
  double k1 = meshes::unknown, k2 = meshes::unknown, k3 = meshes::unknown, kappa = meshes::unknown;
  std::string meaning;
};
FINGERTIP_FIELDS(OpenConstants, k1, k2, k3, kappa, meaning);

/// calibration.json of a fit to moduli.
struct ModuliFile {
  std::string model;
  double spacing = meshes::unknown;
  FitConstants constants;
  DampingEntry damping;
  RubberEntry target;
  AchievedEntry achieved;
  std::optional<std::vector<std::vector<double>>> covariance;
  std::vector<OpenConstants> unidentifiable;
  meshes::Entries<double> residuals;
  std::string statement;

  bool empty() const { return model.empty(); }
};
FINGERTIP_FIELDS(ModuliFile, model, spacing, constants, damping, target, achieved, covariance,
                 unidentifiable, residuals, statement);

}  // namespace fingertip::calibration::inline files
