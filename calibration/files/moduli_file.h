/// calibration.json of a fit to moduli, and what fits to curves have in common with it. SI.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "meshes/press/press_response.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::calibration::inline files {

/// A rubber [Pa].
struct RubberEntry {
  double youngs_modulus = meshes::unknown, shear_modulus = meshes::unknown,
         poissons_ratio = meshes::unknown, bulk_modulus = meshes::unknown;
  std::optional<std::vector<std::vector<double>>> relaxation = {};  ///< shares and times [s]
};
constexpr auto fields_of(const RubberEntry*) {
  using meshes::if_known, meshes::named;
  using Whole = RubberEntry;
  return std::tuple_cat(
      named("youngs_modulus shear_modulus poissons_ratio bulk_modulus", &Whole::youngs_modulus,
            &Whole::shear_modulus, &Whole::poissons_ratio, &Whole::bulk_modulus),
      if_known(named("relaxation", &Whole::relaxation)));
}

/// Spring constants [N/m], volume constant [Pa]; of the network lambda and G besides [Pa].
struct FitConstants {
  double k1 = meshes::unknown, k2 = meshes::unknown, k3 = meshes::unknown, kappa = meshes::unknown,
         lambda = meshes::unknown, G = meshes::unknown;
};
constexpr auto fields_of(const FitConstants*) {
  using meshes::if_known, meshes::named;
  using Whole = FitConstants;
  return std::tuple_cat(named("k1 k2 k3 kappa", &Whole::k1, &Whole::k2, &Whole::k3, &Whole::kappa),
                        if_known(named("lambda G", &Whole::lambda, &Whole::G)));
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
constexpr auto fields_of(const AchievedEntry*) {
  using meshes::named;
  using Whole = AchievedEntry;
  return named(
      "youngs_modulus_100 youngs_modulus_110 youngs_modulus_111 shear_modulus poissons_ratio_100 "
      "bulk_modulus anisotropy",
      &Whole::youngs_modulus_100, &Whole::youngs_modulus_110, &Whole::youngs_modulus_111,
      &Whole::shear_modulus, &Whole::poissons_ratio_100, &Whole::bulk_modulus, &Whole::anisotropy);
}

/// [s].
struct DampingEntry {
  double retardation_time = meshes::unknown;
};
constexpr auto fields_of(const DampingEntry*) {
  using meshes::named;
  using Whole = DampingEntry;
  return named("retardation_time", &Whole::retardation_time);
}

/// A move of the constants that no test of moduli notices.
struct OpenConstants {
  double k1 = meshes::unknown, k2 = meshes::unknown, k3 = meshes::unknown, kappa = meshes::unknown;
  std::string meaning;
};
constexpr auto fields_of(const OpenConstants*) {
  using meshes::named;
  using Whole = OpenConstants;
  return named("k1 k2 k3 kappa meaning", &Whole::k1, &Whole::k2, &Whole::k3, &Whole::kappa,
               &Whole::meaning);
}

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
constexpr auto fields_of(const ModuliFile*) {
  using meshes::named;
  using Whole = ModuliFile;
  return named(
      "model spacing constants damping target achieved covariance unidentifiable residuals "
      "statement",
      &Whole::model, &Whole::spacing, &Whole::constants, &Whole::damping, &Whole::target,
      &Whole::achieved, &Whole::covariance, &Whole::unidentifiable, &Whole::residuals,
      &Whole::statement);
}

}  // namespace fingertip::calibration::inline files
