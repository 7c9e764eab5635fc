#include "meshes/press/limit_surface.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

using namespace fingertip;
using meshes::ContactPoint;
using meshes::LimitSurface;
using meshes::Vector3;

namespace {

constexpr double pi = std::numbers::pi;
using Field = std::vector<ContactPoint>;

/// A round contact of radius a about (1, -2) with p of r/a, force N.
Field round_contact(double a, double N, const std::function<double(double)>& pressure,
                    int rings = 200) {
  Field field;
  double sum = 0.0;
  for (int i = 0; i < rings; ++i) {
    // Gauss' points would not be needed but at the edge: rings get narrower there.
    const auto at = [&](double j) { return std::sin(0.5 * pi * j / rings); };
    ContactPoint ring;
    ring.place.x() = a * at(i + 0.5);
    ring.area = pi * a * a * (std::pow(at(i + 1.0), 2) - std::pow(at(i), 2));
    ring.normal_traction = pressure(at(i + 0.5));
    sum += ring.area * ring.normal_traction;
    for (ContactPoint& point : turned_around(ring, 72)) {
      point.place += Vector3(1.0, -2.0, 0.0);
      field.push_back(point);
    }
  }
  for (ContactPoint& point : field) point.normal_traction *= N / sum;
  return field;
}

double power_law(double k, double r) {
  return std::pow(1.0 - std::pow(r, k), 1.0 / k);
}

double hertz(double r) {
  return power_law(2.0, r);
}

}  // namespace

/// Quadrature by two other programs: F/(mu N) and M/M_max at centres x/a away.
TEST(LimitSurface, OfHertzIsTheTabled) {
  constexpr double a = 0.3, N = 2.0;
  const Field field = round_contact(a, N, hertz);
  const LimitSurface surface = limit_surface(field);
  EXPECT_NEAR(surface.normal_force, N, 1e-12);
  EXPECT_NEAR(surface.radius, a, 2e-3 * a);
  EXPECT_NEAR(surface.greatest_moment, 3.0 * pi / 16.0 * N * a, 1e-3 * N * a);
  EXPECT_NEAR(surface.exponent, 2.0, 0.02);
  constexpr std::array<std::array<double, 3>, 6> table{{{0.1, 0.1175, 0.990},
                                                        {0.25, 0.2899, 0.939},
                                                        {0.5, 0.5522, 0.773},
                                                        {0.75, 0.7593, 0.556},
                                                        {1.0, 0.8836, 0.375},
                                                        {2.0, 0.9743, 0.173}}};
  for (const double direction : {0.0, 1.0})
    for (const auto& [away, force, moment] : table) {
      const auto point = meshes::limit_point(field, away * a, direction);
      EXPECT_NEAR(point.force / N, force, 0.005 * force) << away;
      EXPECT_NEAR(point.moment / surface.greatest_moment, moment, 0.005 * moment) << away;
    }
  EXPECT_NEAR(surface.ellipse_error, 0.063, 0.002);
}

/// Both ends: all friction along one line, or all around the centre.
TEST(LimitSurface, EndsAreForceAndMoment) {
  const Field field = round_contact(0.3, 2.0, [](double r) { return 1.0 - r; });
  const LimitSurface surface = limit_surface(field, 0.4);
  double moment = 0.0;
  for (const ContactPoint& point : field)
    moment += (point.place - Vector3(1.0, -2.0, 0.0)).head<2>().norm() * point.area *
              point.normal_traction;
  EXPECT_NEAR(surface.greatest_moment, moment, 1e-10 * moment);
  EXPECT_EQ(surface.points.front().away, 0.0);
  EXPECT_NEAR(surface.points.front().force, 0.0, 1e-12);
  EXPECT_TRUE(std::isinf(surface.points.back().away));
  EXPECT_NEAR(surface.points.back().force, surface.normal_force, 1e-12);
  EXPECT_NEAR(surface.points.back().moment, 0.0, 1e-12);
  for (std::size_t i = 1; i < surface.points.size(); ++i) {
    EXPECT_GT(surface.points[i].force, surface.points[i - 1].force);
    EXPECT_LT(surface.points[i].moment, surface.points[i - 1].moment);
  }
}

/// Centres of rotation lie all the way out: between neighbours no part of the curve is left out.
TEST(LimitSurface, PointsFollowTheWholeCurve) {
  const Field field = round_contact(0.3, 2.0, hertz);
  const LimitSurface surface = limit_surface(field);
  for (std::size_t i = 1; i < surface.points.size(); ++i) {
    const auto &at = surface.points[i], &before = surface.points[i - 1];
    EXPECT_LT(std::hypot((at.force - before.force) / surface.normal_force,
                         (at.moment - before.moment) / surface.greatest_moment),
              0.12)
        << at.away;
  }
}

/// Greatest power: no other friction of the same pressures opposes a motion with more. The surface
/// is convex, and a motion about its centre is its normal.
TEST(LimitSurface, IsConvexWithMotionsAsNormals) {
  const LimitSurface surface = limit_surface(round_contact(0.3, 2.0, hertz));
  for (const auto& own : surface.points) {
    if (std::isinf(own.away)) continue;
    const double power = own.force * own.away + own.moment;
    for (const auto& other : surface.points)
      EXPECT_LE(other.force * own.away + other.moment, power * (1.0 + 1e-9)) << own.away;
  }
}

/// Xydas & Kao's pressures: greatest moment over mu N a, by quadrature of another program.
TEST(LimitSurface, FindsTheExponent) {
  for (const auto& [k, share] :
       {std::pair{1.8, 0.579}, {2.0, 0.589}, {3.0, 0.620}, {4.0, 0.635}, {8.0, 0.656}}) {
    const LimitSurface surface =
        limit_surface(round_contact(1.0, 1.0, [k = k](double r) { return power_law(k, r); }));
    EXPECT_NEAR(surface.greatest_moment, share, 1e-3) << k;
    EXPECT_NEAR(surface.exponent, k, 0.02 * k) << k;
  }
}

TEST(LimitSurface, RadiiFollowAPower) {
  std::vector<LimitSurface> surfaces;
  EXPECT_TRUE(std::isnan(meshes::radius_law(surfaces).gamma));
  for (const double N : {0.1, 0.5, 2.0}) {
    surfaces.emplace_back().normal_force = N;
    surfaces.back().radius = 3e-3 * std::pow(N, 0.28);
  }
  surfaces.emplace_back();  // without contact
  const meshes::RadiusLaw law = meshes::radius_law(surfaces);
  EXPECT_NEAR(law.factor, 3e-3, 1e-12);
  EXPECT_NEAR(law.gamma, 0.28, 1e-12);
  EXPECT_TRUE(std::isnan(meshes::radius_law(std::vector{surfaces.front()}).gamma));
}

TEST(LimitSurface, WithoutAPushIsUnknown) {
  EXPECT_TRUE(std::isnan(limit_surface(Field{}).normal_force));
  EXPECT_TRUE(limit_surface(Field(3)).points.empty());
}
