#include "fem_reference/analytic/bonded_disc.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "meshes/base/errors.h"
#include "tests/fem_reference/analytic/field_checks.h"

using namespace fingertip::fem_reference::analytic;
using field_checks::rubber;
using fingertip::meshes::InvalidInput;
using std::numbers::pi;

namespace {

/// Energy minimised by hand over u_r = c r (1 - zeta²), u_z = -delta z/H, an upper bound:
/// (lambda + 2G - (4 lambda/3)²/D) A/H with D = 32 (lambda + G)/15 + 8 G R²/(3 H²).
double one_term_bound(const fingertip::meshes::Rubber& material, double radius, double thickness) {
  const double lambda = material.lame_lambda(), G = material.shear_modulus;
  const double D = 32.0 / 15.0 * (lambda + G) + 8.0 / 3.0 * G * std::pow(radius / thickness, 2);
  return (lambda + 2.0 * G - 16.0 / 9.0 * lambda * lambda / D) * pi * radius * radius / thickness;
}

/// E A/H, a lower bound: the uniform stress is statically admissible.
double free_slip(const fingertip::meshes::Rubber& material, double radius, double thickness) {
  return material.youngs_modulus * pi * radius * radius / thickness;
}

struct Reference {
  double thickness, nu, stiffness;
};

/// gf/cm for R = 1 cm, E = 40 gf/cm²; converged by programs outside this repository.
constexpr Reference references[] = {
    {0.5, 3.0 / 7.0, 434.2}, {0.5, 0.25, 283.9}, {1.0, 3.0 / 7.0, 165.2}, {1.0, 0.25, 135.3}};

TEST(BondedDisc, ReproducesTheReferenceStiffnesses) {
  for (const auto& [thickness, nu, stiffness] : references) {
    const BondedDisc disc(rubber(40.0, nu), 1.0, thickness);
    EXPECT_NEAR(disc.stiffness(10) / stiffness, 1.0, 1e-3);
    EXPECT_NEAR(disc.stiffness(20) / stiffness, 1.0, 4e-4);
    EXPECT_NEAR(disc.extrapolated_stiffness(20), stiffness, 0.051);  // as printed
    EXPECT_NEAR(disc.extrapolated_stiffness(20) / disc.extrapolated_stiffness(30), 1.0, 1e-5);
  }
}

TEST(BondedDisc, RitzFallsBetweenTheBounds) {
  for (const auto& material : field_checks::rubbers())
    for (const double thickness : {0.2, 1.0, 3.0}) {
      const BondedDisc disc(material, 1.0, thickness);
      const double rounding = 1e-10 * disc.confined_stiffness();
      double above = one_term_bound(material, 1.0, thickness) + rounding;
      EXPECT_LE(above, disc.confined_stiffness() + 2.0 * rounding);
      for (const int order : {1, 2, 4, 8, 12}) {
        const double stiffness = disc.stiffness(order);
        EXPECT_LE(stiffness, above) << order;
        above = stiffness + rounding;
      }
      EXPECT_GE(above, free_slip(material, 1.0, thickness));
    }
}

TEST(BondedDisc, WithoutPoissonsEffectTheUniformStrainIsExact) {
  const BondedDisc disc(rubber(2.0, 0.0), 1.5, 0.7);
  const double exact = 2.0 * pi * 1.5 * 1.5 / 0.7;
  EXPECT_NEAR(disc.confined_stiffness(), exact, 1e-12);
  EXPECT_NEAR(disc.stiffness(6), exact, 1e-12);
  EXPECT_NEAR(disc.extrapolated_stiffness(6), exact, 1e-12);
}

TEST(BondedDisc, ThinDiscIsConfinedAndLongRodIsFree) {
  const auto material = rubber(2.0, 0.25);
  const BondedDisc layer(material, 1.0, 0.01);
  EXPECT_NEAR(layer.stiffness(20) / layer.confined_stiffness(), 1.0, 0.006);
  EXPECT_LT(layer.stiffness(20), layer.confined_stiffness());
  // A rod's two ends stiffen it by an amount that does not grow with its length: k/k_free - 1 ~
  // 1/H.
  const auto excess = [&](double length) {
    const BondedDisc rod(material, 1.0, length);
    return rod.stiffness(24) / free_slip(material, 1.0, length) - 1.0;
  };
  EXPECT_NEAR(excess(16.0) / excess(8.0), 0.5, 0.01);
}

TEST(BondedDisc, DependsOnShapeAloneBesidesSize) {
  const auto material = rubber(3922.66, 3.0 / 7.0);
  const BondedDisc metres(material, 0.01, 0.005), centimetres(material, 1.0, 0.5);
  EXPECT_NEAR(100.0 * metres.stiffness(8) / centimetres.stiffness(8), 1.0, 1e-12);
}

TEST(BondedDisc, ConvergesAtTheRateOfTheCorner) {
  for (const auto& [thickness, nu, unused] : references) {
    const BondedDisc disc(rubber(40.0, nu), 1.0, thickness);
    const double coarse = disc.stiffness(8), middle = disc.stiffness(16);
    const double rate = std::log2((coarse - middle) / (middle - disc.stiffness(32)));
    EXPECT_NEAR(rate, 4.0 * disc.corner_exponent(), 0.15) << nu;
  }
}

TEST(BondedDisc, CornerExponentIsWilliams) {
  EXPECT_NEAR(BondedDisc(rubber(1.0, 0.0), 1.0, 1.0).corner_exponent(), 1.0, 1e-6);
  // Incompressible: cos(alpha pi/2) = alpha, whose root is 0.594612
  EXPECT_NEAR(BondedDisc(rubber(1.0, 0.4999999), 1.0, 1.0).corner_exponent(), 0.594612, 1e-6);
  // nu = 0.3 (kappa = 1.8), bonded right angle: 0.7112
  EXPECT_NEAR(BondedDisc(rubber(1.0, 0.3), 1.0, 1.0).corner_exponent(), 0.7112, 1e-4);
}

TEST(BondedDisc, RefusesWhatItCannotCompute) {
  EXPECT_THROW_SAYING(BondedDisc(rubber(1.0, 0.3), 0.0, 1.0), InvalidInput, "radius");
  EXPECT_THROW_SAYING(BondedDisc(rubber(1.0, 0.3), 1.0, NAN), InvalidInput, "thickness");
  EXPECT_THROW_SAYING(BondedDisc(rubber(1.0, 0.5), 1.0, 1.0), InvalidInput, "rubber.shear_modulus");
  const BondedDisc disc(rubber(1.0, 0.3), 1.0, 1.0), auxetic(rubber(1.0, -0.3), 1.0, 1.0);
  EXPECT_THROW_SAYING(disc.stiffness(0), InvalidInput, "order = 0");
  EXPECT_THROW_SAYING(disc.stiffness(41), InvalidInput, "order = 41");
  EXPECT_THROW_SAYING(disc.extrapolated_stiffness(7), InvalidInput, "order = 7: must be even");
  EXPECT_THROW_SAYING(disc.extrapolated_stiffness(2), InvalidInput, "order = 2");
  EXPECT_THROW_SAYING(auxetic.corner_exponent(), InvalidInput, "poissons_ratio");
  EXPECT_THROW_SAYING(auxetic.extrapolated_stiffness(8), InvalidInput, "poissons_ratio");
}

}  // namespace
