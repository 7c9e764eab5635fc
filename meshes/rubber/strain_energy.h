/// Which energy a rubber stores at large strain, by the shape of its law: what multiplies it is the
/// shear modulus, so that E and G stay the moduli of small strain whatever the law.
#pragma once

#include <array>
#include <string>

#include "meshes/base/names.h"

namespace fingertip::meshes::inline rubber {

/// With I1, I2 the invariants of C = FᵀF, l the principal stretches, G the shear modulus at rest;
/// `shape` holds, in this order,
///
///   linear          Hooke's law: small strain only
///   neo_hookean     G/2 (I1 - 3)                                         -
///   yeoh            C1 (I1 - 3) + C2 (I1 - 3)² + C3 (I1 - 3)³            C2/G, C3/G; C1 = G/2
///   mooney_rivlin   C10 (I1 - 3) + C01 (I2 - 3)                          C01/(C10 + C01); their
///                                                                        sum is G/2
///   ogden           sum of 2 mu_i/alpha_i² (l1^alpha_i + l2^.. + l3^.. - 3)   mu_i/G, alpha_i, up
///                                                                        to three; sum mu_i = G
///   gent            -G Jm/2 ln(1 - (I1 - 3)/Jm)                          Jm
///
/// (Treloar 1944; Yeoh 1993; Mooney 1940, Rivlin 1948; Ogden 1972; Gent 1996.)
enum class RubberLaw { linear, neo_hookean, yeoh, mooney_rivlin, ogden, gent };
constexpr auto names_of(RubberLaw) {
  using enum RubberLaw;
  return names<RubberLaw>({{linear, "linear"},
                           {neo_hookean, "neo-hookean"},
                           {yeoh, "yeoh"},
                           {mooney_rivlin, "mooney-rivlin"},
                           {ogden, "ogden"},
                           {gent, "gent"}});
}

/// What a change of volume costs, J = det F:
///
///   logarithmic             the law of I1, I2 or l as they are, less g ln J so that rest is free
///                           of stress, plus m/2 (ln J)²; for neo_hookean Simo & Pister 1984
///   quadratic               the law of J^(-2/3) I1, J^(-4/3) I2, J^(-1/3) l (Flory 1961), plus
///                           K/2 (J - 1)²
///   full_quadratic          as logarithmic, but m/2 (J - 1)² (Pence & Gou 2015)
///   isochoric_logarithmic   as quadratic, but K/2 (ln J)² (Simo & Hughes 1998)
///
/// m is what is left of lambda when the law of I1 and I2 has taken its share, so that K is the bulk
/// modulus at rest: lambda for neo_hookean and ogden, lambda - 8 C2 for yeoh, lambda - 4 C01 for
/// mooney_rivlin, lambda - 2 G/Jm for gent.
enum class VolumetricLaw { logarithmic, quadratic, full_quadratic, isochoric_logarithmic };
constexpr auto names_of(VolumetricLaw) {
  using enum VolumetricLaw;
  return names<VolumetricLaw>({{logarithmic, "logarithmic"},
                               {quadratic, "quadratic"},
                               {full_quadratic, "full-quadratic"},
                               {isochoric_logarithmic, "isochoric-logarithmic"}});
}

struct StrainEnergy {
  RubberLaw law = RubberLaw::neo_hookean;
  VolumetricLaw volumetric = VolumetricLaw::logarithmic;
  std::array<double, 6> shape{};  ///< numbers a law has not are 0

  bool operator==(const StrainEnergy&) const = default;

  // Always inline, for kernels of several instruction sets ask: no compiled copy may be shared.
  /// Whether the law sees I1, I2 or l free of the change of volume.
  [[gnu::always_inline]] bool isochoric() const {
    return volumetric == VolumetricLaw::quadratic ||
           volumetric == VolumetricLaw::isochoric_logarithmic;
  }
  /// Whether h(J) is ln J, not J - 1; the volumetric part is m/2 h².
  [[gnu::always_inline]] bool logarithmic() const {
    return volumetric == VolumetricLaw::logarithmic ||
           volumetric == VolumetricLaw::isochoric_logarithmic;
  }
  /// What a law of full invariants takes of lambda at rest, over G.
  double lambda_share() const {
    switch (law) {
      case RubberLaw::yeoh: return 8.0 * shape[0];
      case RubberLaw::mooney_rivlin: return 2.0 * shape[0];
      case RubberLaw::gent: return 2.0 / shape[0];
      default: return 0.0;
    }
  }
};

/// "yeoh, quadratic".
inline std::string describe(const StrainEnergy& energy) {
  return std::string(name(energy.law)) + ", " + std::string(name(energy.volumetric));
}

}  // namespace fingertip::meshes::inline rubber
