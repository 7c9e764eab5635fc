#include "fem_reference/analytic/manufactured_displacement.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/fem_reference/analytic/field_checks.h"

using namespace fingertip::fem_reference::analytic;
using enum ManufacturedDisplacement::Variant;
using field_checks::rubber;
using fingertip::meshes::InvalidInput;

namespace {

const field_checks::Box box{{-0.4, -0.1, 0.0}, {0.6, 0.9, 1.1}};

TEST(Factor, DerivativesAreThoseOfSineAndExponential) {
  const Factor sine{Factor::Kind::sine, 1.7, 0.3};
  const Factor exponential{Factor::Kind::exponential, -0.6, 0.0};
  const double t = 0.8, rate = 1.7, angle = 1.7 * 0.8 + 0.3;
  EXPECT_NEAR(sine.derivative(0, t), std::sin(angle), 1e-15);
  EXPECT_NEAR(sine.derivative(1, t), rate * std::cos(angle), 1e-15);
  EXPECT_NEAR(sine.derivative(2, t), -rate * rate * std::sin(angle), 1e-15);
  EXPECT_NEAR(sine.derivative(3, t), -rate * rate * rate * std::cos(angle), 2e-15);
  EXPECT_NEAR(exponential.derivative(3, t), -0.216 * std::exp(-0.48), 1e-15);
}

TEST(ManufacturedDisplacement, BodyForceKeepsItInEquilibrium) {
  for (const auto& material : field_checks::rubbers())
    for (const auto variant : {general, nearly_solenoidal}) {
      const ManufacturedDisplacement field(material, 1.0, 0.01, variant);
      field_checks::expect_consistent_field(field, material, box);
      field_checks::expect_balanced(field, material, box);
    }
}

TEST(ManufacturedRevolution, BodyForceKeepsItInEquilibrium) {
  for (const auto& material : field_checks::rubbers()) {
    const ManufacturedRevolution field(material, 1.0, 0.01);
    field_checks::expect_consistent_field(field, material, box);
    field_checks::expect_balanced(field, material, box);
  }
}

TEST(ManufacturedRevolution, IsTheSameInEveryMeridian) {
  const ManufacturedRevolution field(rubber(2.0, 0.3), 1.0, 0.01);
  const Matrix3 turn = Eigen::AngleAxisd(0.8, Vector3::UnitZ()).toRotationMatrix();
  for (const Vector3& x : field_checks::random_points(box)) {
    EXPECT_LT((field.displacement(turn * x) - turn * field.displacement(x)).norm(), 1e-16);
    EXPECT_LT((field.body_force(turn * x) - turn * field.body_force(x)).norm(), 1e-14);
    const Vector3 in_plane(x.x(), 0.0, x.z());
    EXPECT_EQ(field.displacement(in_plane).y(), 0.0);
  }
}

TEST(ManufacturedDisplacement, ScalesWithLengthAndAmplitude) {
  const auto material = rubber(2.0, 0.3);
  const Vector3 x(0.2, 0.5, 0.7);
  for (const auto variant : {general, nearly_solenoidal}) {
    const ManufacturedDisplacement large(material, 1.0, 1.0, variant);
    const ManufacturedDisplacement small(material, 0.01, 1e-4, variant);
    EXPECT_LT((small.displacement(0.01 * x) - 1e-4 * large.displacement(x)).norm(), 1e-18);
    EXPECT_LT((small.gradient(0.01 * x) - 1e-2 * large.gradient(x)).norm(), 1e-15);
    EXPECT_LT((small.stress(0.01 * x) - 1e-2 * large.stress(x)).norm(), 1e-15);
    EXPECT_LT((small.body_force(0.01 * x) - large.body_force(x)).norm(), 1e-13);
  }
}

TEST(ManufacturedDisplacement, DilatationIsTheTraceOfTheGradient) {
  for (const auto variant : {general, nearly_solenoidal}) {
    const ManufacturedDisplacement field(rubber(2.0, 0.3), 1.0, 1.0, variant);
    for (const Vector3& x : field_checks::random_points(box))
      EXPECT_NEAR(field.dilatation(x), field.gradient(x).trace(), 1e-14);
  }
}

TEST(ManufacturedDisplacement, PressureAndLoadStayBoundedNearIncompressibility) {
  const Vector3 x(0.2, 0.5, 0.7);
  const auto of = [&](double nu, auto variant) {
    const auto material = rubber(3.0, nu);
    const ManufacturedDisplacement field(material, 1.0, 1.0, variant);
    return std::pair{material.lame_lambda() * field.dilatation(x), field.body_force(x)};
  };
  const auto [p4, f4] = of(0.4999, nearly_solenoidal);
  const auto [p8, f8] = of(0.49999999, nearly_solenoidal);
  EXPECT_GT(std::abs(p8), 0.1);  // of the order of G = 1, and not zero
  EXPECT_NEAR(p4, p8, 1e-3 * std::abs(p8));
  EXPECT_LT((f4 - f8).norm(), 1e-3 * f8.norm());
  const auto [growing4, load4] = of(0.4999, general);
  const auto [growing8, load8] = of(0.49999999, general);
  EXPECT_NEAR(growing8 / growing4, 1e4, 10.0);
  EXPECT_NEAR(load8.norm() / load4.norm(), 1e4, 20.0);
}

TEST(ManufacturedDisplacement, EveryStrainAndLoadComponentIsThere) {
  // A component that vanished, or one that followed from another by symmetry, would test nothing.
  for (const auto variant : {general, nearly_solenoidal}) {
    const ManufacturedDisplacement field(rubber(3.0, 0.3), 1.0, 1.0, variant);
    Matrix3 largest = Matrix3::Zero();
    Vector3 load = Vector3::Zero();
    for (const Vector3& x : field_checks::random_points(box)) {
      largest = largest.cwiseMax(field.stress(x).cwiseAbs());
      load = load.cwiseMax(field.body_force(x).cwiseAbs());
    }
    EXPECT_GT(largest.minCoeff(), 0.1);
    EXPECT_GT(load.minCoeff(), 0.1);
  }
}

TEST(ManufacturedDisplacement, RefusesBadScales) {
  EXPECT_THROW_SAYING(ManufacturedDisplacement(rubber(1.0, 0.3), 0.0, 1.0), InvalidInput, "length");
  EXPECT_THROW_SAYING(ManufacturedDisplacement(rubber(1.0, 0.3), 1.0, NAN), InvalidInput,
                      "amplitude");
  EXPECT_THROW_SAYING(ManufacturedDisplacement(rubber(1.0, 0.5), 1.0, 1.0), InvalidInput,
                      "rubber.shear_modulus");
}

}  // namespace
