#include "fem_reference/analytic/cantilever.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/fem_reference/analytic/field_checks.h"

using namespace fingertip::fem_reference::analytic;
using field_checks::rubber;
using fingertip::meshes::InvalidInput;
using std::numbers::pi;

namespace {

const Cantilever::Parameters bar{0.4, 2.5, 0.03};
const PlaneStrainCantilever::Parameters plate{0.6, 2.0, 0.05};

/// Integral of f(y, z) over the disc of radius R: trapezoidal in the angle, Gauss in the radius.
double over_disc(double radius, const std::function<double(double, double)>& f) {
  constexpr int angles = 16;
  double sum = 0.0;
  for (const auto& [t, weight] : field_checks::gauss_rule())
    for (int i = 0; i < angles; ++i) {
      const double r = radius * t, angle = 2.0 * pi * i / angles;
      sum += weight * radius * r * 2.0 * pi / angles * f(r * std::cos(angle), r * std::sin(angle));
    }
  return sum;
}

double over_height(double height, const std::function<double(double)>& f) {
  double sum = 0.0;
  for (const auto& [t, weight] : field_checks::gauss_rule())
    sum += height * weight * f(height * (t - 0.5));
  return sum;
}

TEST(Cantilever, IsInEquilibrium) {
  const field_checks::Box inside{{0.2, -0.3, -0.25}, {2.1, 0.1, 0.28}};
  for (const auto& material : field_checks::rubbers()) {
    const Cantilever beam(material, bar);
    field_checks::expect_consistent_field(beam, material, inside);
    field_checks::expect_balanced(beam, material, inside);
  }
}

TEST(Cantilever, SideIsFree) {
  const Cantilever beam(rubber(2.0, 0.3), bar);
  const double scale = beam.stress({0.0, 0.0, bar.radius}).norm();
  for (int i = 0; i < 12; ++i) {
    const Vector3 n(0.0, std::cos(i), std::sin(i));
    EXPECT_LT(beam.traction(Vector3(0.2 * i, 0, 0) + bar.radius * n, n).norm(), 1e-14 * scale);
  }
}

TEST(Cantilever, SectionsCarryLoadAndMoment) {
  const Cantilever beam(rubber(2.0, 0.3), bar);
  for (const double x : {0.0, 1.0, bar.length}) {
    const auto resultant = [&](int c, int factor) {
      return over_disc(bar.radius, [&](double y, double z) {
        return beam.stress({x, y, z})(0, c) * (factor == 0 ? 1.0 : factor == 1 ? y : z);
      });
    };
    EXPECT_NEAR(resultant(2, 0), bar.load, 1e-15);
    EXPECT_NEAR(resultant(1, 0), 0.0, 1e-15);
    EXPECT_NEAR(resultant(0, 0), 0.0, 1e-15);
    EXPECT_NEAR(resultant(0, 2), -bar.load * (bar.length - x), 1e-14);  // bending moment
    EXPECT_NEAR(resultant(2, 1) - resultant(1, 2), 0.0, 1e-15);         // torque
  }
}

TEST(Cantilever, MeanDeflectionIsTimoshenkosWithCowpersCoefficient) {
  for (const auto& material : field_checks::rubbers()) {
    const Cantilever beam(material, bar);
    const double area = pi * bar.radius * bar.radius;
    const auto mean_lift = [&](double x) {
      const auto u = [&](double y, double z) { return beam.displacement({x, y, z}).z(); };
      return over_disc(bar.radius, u) / area;
    };
    const double rotation = over_disc(bar.radius, [&](double y, double z) {
      return z * beam.displacement({0.0, y, z}).x();
    });
    EXPECT_NEAR(mean_lift(0.0), 0.0, 1e-14 * beam.tip_deflection());
    EXPECT_NEAR(rotation, 0.0, 1e-14 * beam.tip_deflection());
    EXPECT_NEAR(mean_lift(bar.length) / beam.tip_deflection(), 1.0, 1e-13);
  }
}

TEST(Cantilever, KnownNumbers) {
  // nu = 0.3: sigma_xz in the middle is 1.38 P/A (Timoshenko & Goodier); kappa 7.8/8.8
  const Cantilever beam(rubber(2.0, 0.3), bar);
  const double mean = bar.load / (pi * bar.radius * bar.radius);
  EXPECT_NEAR(beam.stress({1.0, 0.0, 0.0})(0, 2) / mean, 1.38, 0.005);
  EXPECT_NEAR(beam.stress({1.0, bar.radius, 0.0})(0, 2) / mean, 1.23, 0.005);
  EXPECT_NEAR(beam.shear_coefficient(), 7.8 / 8.8, 1e-14);
  // A slender beam is Euler's: P L³/(3 E I).
  const Cantilever slender(rubber(2.0, 0.3), {0.01, 10.0, 1e-9});
  const double euler = 1e-9 * 1000.0 / (3.0 * 2.0 * slender.second_moment());
  EXPECT_NEAR(slender.displacement({10.0, 0.0, 0.0}).z() / euler, 1.0, 1e-5);
}

TEST(Cantilever, IsSymmetricAboutTheBendingPlane) {
  const Cantilever beam(rubber(2.0, 0.3), bar);
  const Vector3 mirror(1.0, -1.0, 1.0), x(0.7, 0.2, -0.1);
  const Vector3 u = beam.displacement(x), reflected = beam.displacement(mirror.cwiseProduct(x));
  EXPECT_LT((mirror.cwiseProduct(u) - reflected).norm(), 1e-15);
  const Vector3 below = beam.displacement({0.7, 0.2, 0.1});  // bending is odd in z
  EXPECT_LT((Vector3(-1, -1, 1).cwiseProduct(u) - below).norm(), 1e-15);
}

TEST(Cantilever, RefusesWhatIsNoBar) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Cantilever(rubber(1.0, 0.3), {0.0, 1.0, 1.0}), InvalidInput);
  EXPECT_THROW(Cantilever(rubber(1.0, 0.3), {1.0, -1.0, 1.0}), InvalidInput);
  EXPECT_THROW(Cantilever(rubber(1.0, 0.3), {1.0, 1.0, nan}), InvalidInput);
  EXPECT_THROW(Cantilever(rubber(1.0, 0.5), {1.0, 1.0, 1.0}), InvalidInput);
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
