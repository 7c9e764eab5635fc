#include "fem_reference/analytic/elastic_field.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/fem_reference/analytic/field_checks.h"

using namespace fingertip::fem_reference::analytic;
using fingertip::meshes::InvalidInput;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

TEST(HookeStress, PullsABarAsYoungAndPoissonSay) {
  for (const auto& rubber : field_checks::rubbers()) {
    const double nu = rubber.poissons_ratio();
    const Matrix3 stress =
        hooke_stress(rubber, 0.01 * Vector3(-nu, 1.0, -nu).asDiagonal().toDenseMatrix());
    Matrix3 expected = Matrix3::Zero();
    expected(1, 1) = 0.01 * rubber.youngs_modulus;
    EXPECT_LT((stress - expected).norm(), 1e-15 * rubber.bulk_modulus());
  }
}

TEST(HookeStress, IgnoresRotation) {
  const auto rubber = field_checks::rubber(2.0, 0.3);
  for (int axis = 0; axis < 3; ++axis) {
    Matrix3 skew = Matrix3::Zero();
    skew((axis + 2) % 3, (axis + 1) % 3) = 1.0;
    skew((axis + 1) % 3, (axis + 2) % 3) = -1.0;
    EXPECT_EQ(hooke_stress(rubber, skew).norm(), 0.0);
  }
}

TEST(HookeStress, ShearsWithTheShearModulus) {
  const auto rubber = field_checks::rubber(2.0, 0.25);  // G = 0.8
  Matrix3 gradient = Matrix3::Zero();
  gradient(0, 2) = 0.5;
  const Matrix3 stress = hooke_stress(rubber, gradient);
  EXPECT_DOUBLE_EQ(stress(0, 2), 0.4);
  EXPECT_DOUBLE_EQ(stress(2, 0), 0.4);
  EXPECT_NEAR(stress.norm(), 0.4 * std::sqrt(2.0), 1e-15);
}

TEST(Checks, NameTheOffender) {
  EXPECT_EQ(checked_positive("a", 2.0), 2.0);
  EXPECT_EQ(checked_finite("a", -2.0), -2.0);
  for (const double bad : {0.0, -1.0, not_a_number, std::numeric_limits<double>::infinity()}) {
    try {
      checked_positive("outer_radius", bad);
      FAIL() << bad;
    } catch (const InvalidInput& error) {
      ASSERT_EQ(error.violations().size(), 1u);
      EXPECT_EQ(error.violations().front().key, "outer_radius");
      EXPECT_FALSE(error.violations().front().value.empty());
    }
  }
  EXPECT_THROW_SAYING(checked_finite("a", not_a_number), InvalidInput, "a = nan");
  EXPECT_THROW_SAYING(checked(field_checks::rubber(1.0, 0.5)), InvalidInput,
                      "rubber.shear_modulus");
  EXPECT_THROW_SAYING(checked(field_checks::rubber(-1.0, 0.3)), InvalidInput,
                      "rubber.youngs_modulus");
}

}  // namespace
