#include "fem_reference/analytic/thick_shell.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/fem_reference/analytic/field_checks.h"

using namespace fingertip::fem_reference::analytic;
using field_checks::rubber;
using fingertip::meshes::InvalidInput;

namespace {

const field_checks::Box inside{{0.3, -1.0, 0.4}, {1.0, -0.4, 1.2}};

TEST(ThickCylinder, IsInEquilibrium) {
  for (const auto& material : field_checks::rubbers()) {
    const ThickCylinder cylinder(material, {0.5, 1.6, 0.3, -0.2});
    field_checks::expect_consistent_field(cylinder, material, inside);
    field_checks::expect_balanced(cylinder, material, inside);
  }
}

TEST(ThickCylinder, CarriesThePressuresAndItsSmoothEnds) {
  const ThickCylinder cylinder(rubber(2.0, 0.4), {0.5, 1.25, 0.3, 0.7});
  const Vector3 axis = Vector3::UnitZ(), height = 0.7 * axis;
  for (const double angle : {0.0, 1.0, 2.5, 4.0}) {
    const Vector3 n(std::cos(angle), std::sin(angle), 0.0);
    EXPECT_LT((cylinder.traction(0.5 * n + height, -n) - 0.3 * n).norm(), 1e-14);
    EXPECT_LT((cylinder.traction(1.25 * n + height, n) + 0.7 * n).norm(), 1e-14);
    const Vector3 end = cylinder.traction(0.9 * n + height, axis);
    EXPECT_LT(end.cross(axis).norm(), 1e-15);
    EXPECT_EQ(cylinder.displacement(0.9 * n + height).z(), 0.0);
  }
}

TEST(ThickCylinder, HoopStressOfAHollowCylinderOfRatioTwo) {
  // p (a² + b²)/(b² - a²) inside and 2 p a²/(b² - a²) outside
  const ThickCylinder cylinder(rubber(7.0, 0.1), {1.0, 2.0, 1.0, 0.0});
  EXPECT_NEAR(cylinder.hoop_stress(1.0), 5.0 / 3.0, 1e-15);
  EXPECT_NEAR(cylinder.hoop_stress(2.0), 2.0 / 3.0, 1e-15);
}

TEST(ThickCylinder, PlaneStrainFixesTheAxialStress) {
  for (const auto& material : field_checks::rubbers()) {
    const ThickCylinder cylinder(material, {0.4, 1.0, 0.8, 0.1});
    const double in_plane = cylinder.radial_stress(0.7) + cylinder.hoop_stress(0.7);
    EXPECT_NEAR(cylinder.stress({0.7, 0.0, 0.0})(2, 2), material.poissons_ratio() * in_plane, 1e-9);
  }
}

TEST(ThickCylinder, ThinTubeObeysTheBoilerFormula) {
  // sigma_tt = p R/t and u = p R² (1 - nu²)/(E t) to first order in t/R
  const auto material = rubber(2.0, 0.3);
  for (const double t : {1e-2, 1e-4}) {
    const ThickCylinder tube(material, {1.0 - t / 2.0, 1.0 + t / 2.0, 1.0, 0.0});
    EXPECT_NEAR(tube.hoop_stress(1.0) * t, 1.0, 2.0 * t);
    EXPECT_NEAR(tube.radial_displacement(1.0) * 2.0 * t / 0.91, 1.0, 3.0 * t);
  }
}

TEST(ThickCylinder, RefusesWhatIsNoTube) {
  const auto good = rubber(1.0, 0.3);
  EXPECT_THROW_SAYING(ThickCylinder(good, {0.0, 1.0, 1.0, 0.0}), InvalidInput, "inner_radius");
  EXPECT_THROW_SAYING(ThickCylinder(good, {1.0, 0.9, 1.0, 0.0}), InvalidInput, "outer_radius");
  EXPECT_THROW_SAYING(ThickCylinder(good, {NAN, 1.0, 1.0, 0.0}), InvalidInput, "inner_radius");
  EXPECT_THROW_SAYING(ThickCylinder(good, {0.5, 1.0, NAN, 0.0}), InvalidInput, "inner_pressure");
  EXPECT_THROW_SAYING(ThickCylinder(good, {0.5, 1.0, 0.0, NAN}), InvalidInput, "outer_pressure");
  EXPECT_THROW_SAYING(ThickCylinder(rubber(1.0, 0.6), {0.5, 1.0, 1.0, 0.0}), InvalidInput,
                      "rubber.shear_modulus");
}

}  // namespace
