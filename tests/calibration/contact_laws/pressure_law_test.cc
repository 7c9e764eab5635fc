// Pressures over penetration whose forces on spheres are known in closed form.

#include "calibration/contact_laws/pressure_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "meshes/base/errors.h"

using namespace fingertip;
using namespace fingertip::calibration;

namespace {

constexpr double pi = std::numbers::pi, R = 0.01, depth = 3e-3;

const GapField& dome_on_plane() {
  static const GapField field = gap_field({}, {}, depth);
  return field;
}

/// Of p = k d^n on a ball of radius R against a plane: 2πk ∫ (d - g)^n (R - g) dg.
double power_force(double k, double n, double d) {
  return 2.0 * pi * k * std::pow(d, n + 1.0) / (n + 1.0) * (R - d / (n + 2.0));
}

template <typename Force>
ForceCurve curve_of(const Force& force, int samples = 12) {
  ForceCurve curve;
  for (int i = 1; i <= samples; ++i) {
    curve.indentation.push_back(depth * i / samples);
    curve.force.push_back(force(curve.indentation.back()));
  }
  return curve;
}

}  // namespace

TEST(GapField, OfADomeIsTheCap) {
  // Area of the cap's section at depth d: π (2Rd - d²), counted ring by ring of 0.03 mm.
  for (const double d : {0.5e-3, 1e-3, 2e-3, 3e-3}) {
    const double radius = std::sqrt(2 * R * d - d * d);
    EXPECT_NEAR(dome_on_plane().overlap(d), pi * radius * radius, 2 * pi * radius * 0.03e-3) << d;
  }
}

TEST(GapField, OnABallIsThatOfBothRadii) {
  const double r = 0.005;
  const meshes::Obstacle ball{meshes::ObstacleShape::sphere, r};
  const GapField field = gap_field({}, ball, 1e-3);
  // Shallow overlaps: area 2π R r/(R + r) d.
  const double d = 0.2e-3;
  EXPECT_NEAR(field.overlap(d) / (2 * pi * R * r / (R + r) * d), 1.0, 0.03);
  EXPECT_LT(field.overlap(1e-3), dome_on_plane().overlap(1e-3));
}

TEST(GapField, OnACylinderAndAnEdgeIsWiderAlongThem) {
  const auto area = [](meshes::ObstacleShape shape) {
    return gap_field({}, {shape, 0.005}, 1e-3).overlap(0.2e-3);
  };
  const double ball = area(meshes::ObstacleShape::sphere), plane = dome_on_plane().overlap(0.2e-3);
  const double cylinder = area(meshes::ObstacleShape::cylinder);
  EXPECT_GT(cylinder, ball);
  EXPECT_LT(cylinder, plane);
  // Ellipse with axes of both curvatures: area 2π sqrt(Rx Ry) d.
  EXPECT_NEAR(cylinder / (2 * pi * std::sqrt(R * (R * 0.005 / (R + 0.005))) * 0.2e-3), 1.0, 0.03);
}

/// By distance a dome's law p = k d is Drake's ball.
TEST(SurfaceDistances, OfADomeAreThoseToItsCentre) {
  const HydroelasticBall ball{1e5, R};
  const PressurePolynomial law{ball.modulus / R, 0.0, 0.0};
  for (const meshes::Obstacle& obstacle :
       {meshes::Obstacle{}, meshes::Obstacle{meshes::ObstacleShape::sphere, 0.005},
        meshes::Obstacle{meshes::ObstacleShape::cylinder, 0.008}}) {
    const Overlaps overlaps = surface_distances({}, obstacle, depth);
    for (const double d : {0.25e-3, 1e-3, 3e-3})
      EXPECT_NEAR(force_of(law, overlaps(d)) / ball.force(obstacle, d), 1.0, 6e-3) << d;
  }
  const Overlaps overlaps = surface_distances({}, {}, depth);
  const ForceCurve curve = curve_of([&](double d) { return ball.force({}, d); });
  EXPECT_NEAR(fitted_line(curve, overlaps).first, law.first, 3e-3 * law.first);
  const PressureTable table = fitted_table(curve, overlaps);
  for (const double d : {0.5e-3, 1.3e-3, 2.6e-3})
    EXPECT_NEAR(table.at(d), law.at(d), 0.02 * law.at(depth)) << d;
}

TEST(PressureLaws, ForcesOfPowersAreThoseOfTheIntegral) {
  for (const double n : {0.5, 1.0, 2.0}) {
    const PowerLaw law{1e5 * std::pow(1e-3, -n), n};
    for (const double d : {0.25e-3, 1e-3, 3e-3})
      EXPECT_NEAR(force_of(law, dome_on_plane()(d)) / power_force(law.stiffness, n, d), 1.0, 3e-3)
          << n << ", " << d;
  }
}

TEST(PressureLaws, PowersAndPolynomialsAreFoundAgain) {
  for (const double n : {0.4, 0.5, 1.0, 1.7}) {
    const double k = 2e4 * std::pow(1e-3, -n);
    const PowerLaw found =
        fitted_power(curve_of([&](double d) { return power_force(k, n, d); }), dome_on_plane());
    EXPECT_NEAR(found.exponent, n, 5e-3);
    EXPECT_NEAR(found.at(1e-3) / 2e4, 1.0, 5e-3);
  }
  const PressurePolynomial wanted{2e7, 3e9, 1e12};
  const PressurePolynomial found = fitted_polynomial(
      curve_of([&](double d) { return force_of(wanted, dome_on_plane()(d)); }), dome_on_plane());
  EXPECT_NEAR(found.first / wanted.first, 1.0, 1e-8);
  EXPECT_NEAR(found.second / wanted.second, 1.0, 1e-6);
  EXPECT_NEAR(found.third / wanted.third, 1.0, 1e-6);
}

TEST(PressureLaws, PolynomialsNeverFallWithinTheCurve) {
  EXPECT_TRUE((PressurePolynomial{1.0, -1.0, 1.0}.grows_to(2.0)));   // 1 - 2d + 3d² > 0
  EXPECT_FALSE((PressurePolynomial{1.0, -2.0, 1.0}.grows_to(2.0)));  // falls between 1/3 and 1
  EXPECT_TRUE((PressurePolynomial{1.0, -2.0, 1.0}.grows_to(0.3)));
  EXPECT_FALSE((PressurePolynomial{1.0, 0.0, -1.0}.grows_to(1.0)));
  // Concave, then convex.
  const PressurePolynomial wanted{4e7, -1e10, 2e12};
  const PressurePolynomial found = fitted_polynomial(
      curve_of([&](double d) { return force_of(wanted, dome_on_plane()(d)); }), dome_on_plane());
  EXPECT_NEAR(found.second / wanted.second, 1.0, 1e-6);
  // A curve whose pressure would fall.
  const PressurePolynomial held =
      fitted_polynomial(curve_of([](double d) { return std::sqrt(d); }), dome_on_plane());
  EXPECT_TRUE(held.grows_to(depth));
}

TEST(PressureLaws, AHertzCurveAsksForASquareRoot) {
  // F' = 2πR p for shallow contacts: p = k d^(1/2)/(πR) (3/4) of F = k d^(3/2).
  const ForceCurve hertz = [] {
    ForceCurve curve = curve_of([](double d) { return 500.0 * std::pow(d, 1.5); });
    for (double& d : curve.indentation) d *= 0.05;
    for (std::size_t i = 0; i < curve.force.size(); ++i)
      curve.force[i] = 500.0 * std::pow(curve.indentation[i], 1.5);
    return curve;
  }();
  const GapField shallow = gap_field({}, {}, 0.05 * depth);
  const PowerLaw law = fitted_power(hertz, shallow);
  EXPECT_NEAR(law.exponent, 0.5, 0.02);
  EXPECT_NEAR(law.at(1e-4) / (0.75 * 500.0 / (pi * R) * std::sqrt(1e-4)), 1.0, 0.02);
}

TEST(PressureLaws, ATableMeetsCurvesThatStiffenAndTheirPressure) {
  // From p ~ d^(1/2), steep at first, to p ~ d^2, which chords between knots exceed.
  for (const double n : {0.5, 1.0, 2.0}) {
    const PowerLaw law{2e4 * std::pow(1e-3, -n), n};
    const PressureTable table = fitted_table(
        curve_of([&](double d) { return force_of(law, dome_on_plane()(d)); }), dome_on_plane());
    for (int i = 2; i <= 36; ++i) {
      const double d = depth * i / 36.0;
      EXPECT_NEAR(force_of(table, dome_on_plane()(d)) / force_of(law, dome_on_plane()(d)), 1.0,
                  0.02)
          << n << ", " << d;
      if (i > 3) {
        EXPECT_NEAR(table.at(d) / law.at(d), 1.0, 0.1) << n << ", " << d;
      }
    }
  }
}

TEST(PressureLaws, ATableIsStraightBetweenItsKnots) {
  const ForceCurve curve =
      curve_of([](double d) { return 300.0 * std::pow(d, 1.6) + 2e6 * d * d * d; });
  const PressureTable table = fitted_table(curve, dome_on_plane());
  ASSERT_EQ(table.pressure.size(), 15U);
  EXPECT_TRUE(std::ranges::is_sorted(table.pressure));
  for (std::size_t i = 0; i < curve.force.size(); ++i)
    EXPECT_NEAR(force_of(table, dome_on_plane()(curve.indentation[i])) / curve.force[i], 1.0, 5e-3);
  // Between and beyond the knots straight lines.
  const double middle = 0.5 * (table.penetration[4] + table.penetration[5]);
  EXPECT_NEAR(table.at(middle), 0.5 * (table.pressure[4] + table.pressure[5]),
              1e-9 * table.at(middle));
  EXPECT_GT(table.at(1.1 * depth), table.pressure.back());
  EXPECT_EQ(table.at(0.0), 0.0);
}

TEST(PressureLaws, ATableNeverFalls) {
  // A curve that grows ever more slowly asks for pressures that fall.
  const ForceCurve curve = curve_of([](double d) { return std::sqrt(d); });
  const PressureTable table = fitted_table(curve, dome_on_plane());
  EXPECT_TRUE(std::ranges::is_sorted(table.pressure));
  EXPECT_GT(std::abs(force_of(table, dome_on_plane()(depth)) / curve.force.back() - 1.0), 0.1);
}

TEST(PressureLaws, CurvesThatDoNotGrowAreRefused) {
  EXPECT_THROW(fitted_table({{1e-3}, {1.0}}, dome_on_plane()), meshes::InvalidInput);
  EXPECT_THROW(fitted_power({{1e-3, 2e-3}, {1.0, 0.9}}, dome_on_plane()), meshes::InvalidInput);
  EXPECT_THROW(fitted_line({{1e-3, 1e-3}, {1.0, 1.1}}, dome_on_plane()), meshes::InvalidInput);
  EXPECT_THROW(fitted_polynomial({{1e-3, 2e-3}, {0.0, 1.0}}, dome_on_plane()),
               meshes::InvalidInput);
}
