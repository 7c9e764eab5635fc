#include "fem_reference/analytic/thick_shell.h"

#include <gtest/gtest.h>

#include "tests/fem_reference/analytic/field_checks.h"

using namespace fingertip::fem_reference::analytic;
using field_checks::rubber;
using fingertip::meshes::InvalidInput;

namespace {

const field_checks::Box inside{{0.3, -0.9, 0.4}, {0.9, -0.3, 0.9}};

TEST(ThickSphere, IsInEquilibrium) {
  for (const auto& material : field_checks::rubbers()) {
    const ThickSphere sphere(material, {0.5, 1.6, 0.3, -0.2});
    field_checks::expect_consistent_field(sphere, material, inside);
    field_checks::expect_balanced(sphere, material, inside);
  }
}

TEST(ThickSphere, CarriesThePressures) {
  const ThickSphere sphere(rubber(2.0, 0.4), {0.5, 1.25, 0.3, 0.7});
  for (const Vector3& direction : {Vector3(1, 2, -2), Vector3(0, 0, 1), Vector3(-3, 1, 0.5)}) {
    const Vector3 n = direction.normalized();
    EXPECT_LT((sphere.traction(0.5 * n, -n) - 0.3 * n).norm(), 1e-14);
    EXPECT_LT((sphere.traction(1.25 * n, n) + 0.7 * n).norm(), 1e-14);
    EXPECT_NEAR(sphere.displacement(0.8 * n).dot(n), sphere.radial_displacement(0.8), 1e-15);
  }
}

TEST(ThickSphere, TangentialStressOfAHollowSphereOfRatioTwo) {
  // p (a³ + b³/2)/(b³ - a³) inside and 3/2 p a³/(b³ - a³) outside
  const ThickSphere sphere(rubber(7.0, 0.1), {1.0, 2.0, 1.0, 0.0});
  EXPECT_NEAR(sphere.hoop_stress(1.0), 5.0 / 7.0, 1e-15);
  EXPECT_NEAR(sphere.hoop_stress(2.0), 3.0 / 14.0, 1e-15);
}

TEST(ThickSphere, EqualPressuresCompressUniformly) {
  for (const auto& material : field_checks::rubbers()) {
    const double p = 0.01 * material.youngs_modulus;
    const ThickSphere sphere(material, {0.4, 1.0, p, p});
    const Vector3 x(0.3, 0.5, -0.4);
    EXPECT_LT((sphere.stress(x) + p * Matrix3::Identity()).norm(), 1e-12 * p);
    EXPECT_LT((sphere.displacement(x) + p / (3.0 * material.bulk_modulus()) * x).norm(), 1e-15);
  }
}

TEST(ThickSphere, ThinShellObeysTheMembraneFormula) {
  // sigma_tt = p R/(2t) and u = p R² (1 - nu)/(2 E t) to first order in t/R
  const auto material = rubber(2.0, 0.3);
  for (const double t : {1e-2, 1e-4}) {
    const ThickSphere sphere(material, {1.0 - t / 2.0, 1.0 + t / 2.0, 1.0, 0.0});
    EXPECT_NEAR(sphere.hoop_stress(1.0) * 2.0 * t, 1.0, 2.0 * t);
    EXPECT_NEAR(sphere.radial_displacement(1.0) * 2.0 * 2.0 * t / 0.7, 1.0, 3.0 * t);
  }
}

TEST(ThickSphere, CavityInAnIncompressibleSpaceOpensByShearAlone) {
  // nu -> 1/2, b -> infinity: u(a) = p a/(4 G)
  const auto material = rubber(3.0, 0.4999999);
  const ThickSphere sphere(material, {0.1, 1e3, 0.2, 0.0});
  EXPECT_NEAR(sphere.radial_displacement(0.1), 0.2 * 0.1 / (4.0 * material.shear_modulus), 1e-9);
}

TEST(ThickSphere, RefusesWhatIsNoShell) {
  const auto good = rubber(1.0, 0.3);
  EXPECT_THROW_SAYING(ThickSphere(good, {0.0, 1.0, 1.0, 0.0}), InvalidInput, "inner_radius");
  EXPECT_THROW_SAYING(ThickSphere(good, {1.0, 1.0, 1.0, 0.0}), InvalidInput, "outer_radius");
  EXPECT_THROW_SAYING(ThickSphere(good, {0.5, NAN, 1.0, 0.0}), InvalidInput, "outer_radius");
  EXPECT_THROW_SAYING(ThickSphere(good, {0.5, 1.0, NAN, 0.0}), InvalidInput, "inner_pressure");
  EXPECT_THROW_SAYING(ThickSphere(good, {0.5, 1.0, 0.0, NAN}), InvalidInput, "outer_pressure");
  EXPECT_THROW_SAYING(ThickSphere(rubber(1.0, 0.5), {0.5, 1.0, 1.0, 0.0}), InvalidInput,
                      "rubber.shear_modulus");
}

}  // namespace
