#include "fem_reference/analytic/rigid_modes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <limits>

#include "tests/fem_reference/analytic/field_checks.h"

using namespace fingertip::fem_reference::analytic;
using fingertip::meshes::InvalidInput;

namespace {

const Vector3 centre(0.3, -0.2, 0.5), x(1.1, 0.4, -0.7);

TEST(RigidModes, TranslateAndRotate) {
  const RigidModes modes(centre);
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3 e = Vector3::Unit(axis);
    EXPECT_EQ(modes.displacement(axis, x), e);
    EXPECT_LT((modes.displacement(axis + 3, x) - e.cross(x - centre)).norm(), 1e-16);
    EXPECT_EQ(modes.displacement(axis + 3, centre).norm(), 0.0);
  }
}

TEST(RigidModes, AreTheSmallLimitOfFiniteRotations) {
  const RigidModes modes(centre);
  const double angle = 1e-6;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::AngleAxisd turn(angle, Vector3::Unit(axis));
    const Vector3 moved = turn * (x - centre) + centre - x;
    EXPECT_LT((moved / angle - modes.displacement(axis + 3, x)).norm(), 2e-6);
  }
}

TEST(RigidModes, GradientIsSkewAndThatOfTheDisplacement) {
  const RigidModes modes(centre);
  for (int mode = 0; mode < RigidModes::count; ++mode) {
    const Matrix3 gradient = modes.gradient(mode);
    EXPECT_EQ((gradient + gradient.transpose()).norm(), 0.0);
    const Vector3 step(0.3, -0.4, 0.2);
    const Vector3 change = modes.displacement(mode, x + step) - modes.displacement(mode, x);
    EXPECT_LT((gradient * step - change).norm(), 1e-15);
  }
}

TEST(RigidModes, AreIndependent) {
  const RigidModes modes(centre);
  Eigen::Matrix<double, 9, 6> at_three_points;
  at_three_points << modes.basis({0, 0, 0}), modes.basis({1, 0, 0}), modes.basis({0, 1, 0});
  EXPECT_EQ(at_three_points.colPivHouseholderQr().rank(), 6);
  for (int mode = 0; mode < RigidModes::count; ++mode)
    EXPECT_EQ(modes.basis(x).col(mode), modes.displacement(mode, x));
}

TEST(RigidModes, RefuseOtherNumbers) {
  const RigidModes modes;
  EXPECT_THROW(modes.displacement(-1, x), InvalidInput);
  EXPECT_THROW(modes.displacement(6, x), InvalidInput);
  EXPECT_THROW(modes.gradient(6), InvalidInput);
  EXPECT_THROW(RigidModes({0.0, std::numeric_limits<double>::quiet_NaN(), 0.0}), InvalidInput);
}

}  // namespace
