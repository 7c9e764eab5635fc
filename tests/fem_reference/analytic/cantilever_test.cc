#include "fem_reference/analytic/cantilever.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "tests/fem_reference/analytic/field_checks.h"

using namespace fingertip::fem_reference::analytic;
using field_checks::rubber;
using fingertip::meshes::InvalidInput;

namespace {

const PlaneStrainCantilever::Parameters plate{0.6, 2.0, 0.05};

double over_height(double height, const std::function<double(double)>& f) {
  double sum = 0.0;
  for (const auto& [t, weight] : field_checks::gauss_rule())
    sum += height * weight * f(height * (t - 0.5));
  return sum;
}

TEST(PlaneStrainCantilever, IsInEquilibrium) {
  const field_checks::Box inside{{0.2, -0.3, -0.3}, {1.8, 0.4, 0.28}};
  for (const auto& material : field_checks::rubbers()) {
    const PlaneStrainCantilever beam(material, plate);
    field_checks::expect_consistent_field(beam, material, inside);
    field_checks::expect_balanced(beam, material, inside);
  }
}

TEST(PlaneStrainCantilever, FacesAreFreeAndWallsSmooth) {
  const PlaneStrainCantilever beam(rubber(2.0, 0.3), plate);
  for (const double x : {0.0, 0.7, 2.0})
    for (const double side : {-1.0, 1.0}) {
      const Vector3 on_face(x, 0.4, side * plate.height / 2.0);
      EXPECT_LT(beam.traction(on_face, side * Vector3::UnitZ()).norm(), 1e-15);
      const Vector3 on_wall(x, side, 0.1);
      EXPECT_EQ(beam.displacement(on_wall).y(), 0.0);
      EXPECT_LT(beam.traction(on_wall, Vector3::UnitY()).cross(Vector3::UnitY()).norm(), 1e-15);
    }
}

TEST(PlaneStrainCantilever, SectionsCarryLoadAndMoment) {
  const PlaneStrainCantilever beam(rubber(2.0, 0.3), plate);
  for (const double x : {0.0, 1.0, plate.length}) {
    const auto stress = [&](double z, int c) { return beam.stress({x, 0.0, z})(0, c); };
    const auto shear = [&](double z) { return stress(z, 2); };
    const auto moment = [&](double z) { return z * stress(z, 0); };
    EXPECT_NEAR(over_height(plate.height, shear), plate.load_per_width, 1e-15);
    EXPECT_NEAR(over_height(plate.height, moment), -plate.load_per_width * (plate.length - x),
                1e-15);
  }
}

TEST(PlaneStrainCantilever, MeanDeflectionIsTimoshenkosWithCowpersCoefficient) {
  for (const auto& material : field_checks::rubbers()) {
    const PlaneStrainCantilever beam(material, plate);
    const auto mean_lift = [&](double x) {
      const auto u = [&](double z) { return beam.displacement({x, 0.3, z}).z(); };
      return over_height(plate.height, u) / plate.height;
    };
    const double rotation = over_height(plate.height, [&](double z) {
      return z * beam.displacement({0.0, 0.3, z}).x();
    });
    EXPECT_NEAR(mean_lift(0.0), 0.0, 1e-14 * beam.tip_deflection());
    EXPECT_NEAR(rotation, 0.0, 1e-14 * beam.tip_deflection());
    EXPECT_NEAR(mean_lift(plate.length) / beam.tip_deflection(), 1.0, 1e-13);
  }
}

TEST(PlaneStrainCantilever, WithoutPoissonsEffectTheShearCoefficientIsFiveSixths) {
  EXPECT_NEAR(PlaneStrainCantilever(rubber(2.0, 0.0), plate).shear_coefficient(), 5.0 / 6.0, 1e-15);
}

TEST(PlaneStrainCantilever, RefusesWhatIsNoPlate) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(PlaneStrainCantilever(rubber(1.0, 0.3), {0.0, 1.0, 1.0}), InvalidInput);
  EXPECT_THROW(PlaneStrainCantilever(rubber(1.0, 0.3), {1.0, 0.0, 1.0}), InvalidInput);
  EXPECT_THROW(PlaneStrainCantilever(rubber(1.0, 0.3), {1.0, 1.0, nan}), InvalidInput);
  EXPECT_THROW(PlaneStrainCantilever(rubber(0.0, 0.3), {1.0, 1.0, 1.0}), InvalidInput);
}

}  // namespace
