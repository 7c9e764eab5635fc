#include "fem_reference/analytic/hertz.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "meshes/base/errors.h"
#include "tests/fem_reference/analytic/field_checks.h"

using namespace fingertip::fem_reference::analytic;
using field_checks::rubber;
using fingertip::meshes::InvalidInput;
using std::numbers::pi;

namespace {

/// Midpoint rule on [0, 1].
double integral(const std::function<double(double)>& f, int cells) {
  double sum = 0.0;
  for (int i = 0; i < cells; ++i) sum += f((i + 0.5) / cells);
  return sum / cells;
}

/// Boussinesq: a pressure p on a half-space moves the surface at distance r by
/// 1/(pi E*) ∫∫ p(|x + s e|) ds dphi in polar coordinates (s, phi) about the point x.
double boussinesq(const Hertz& hertz, double modulus, double r, double indentation, int cells) {
  const double a = hertz.contact_radius(indentation);
  const auto along_ray = [&](double phi) {
    // The ray meets the contact where s² + 2 r s cos phi + r² < a².
    const double middle = -r * std::cos(phi);
    const double half_squared = a * a - r * r * std::sin(phi) * std::sin(phi);
    if (half_squared <= 0.0) return 0.0;
    const double from = std::max(0.0, middle - std::sqrt(half_squared));
    const double to = std::max(0.0, middle + std::sqrt(half_squared));
    return (to - from) * integral(
                             [&](double t) {
                               // smooth substitution t² (3 - 2t): the pressure ends like a root
                               const double s = from + (to - from) * t * t * (3.0 - 2.0 * t);
                               const double distance = std::sqrt(
                                   std::max(0.0, s * s + 2.0 * r * s * std::cos(phi) + r * r));
                               return 6.0 * t * (1.0 - t) * hertz.pressure(distance, indentation);
                             },
                             cells);
  };
  // Seen from outside, the contact fills a sector about phi = pi.
  const double sector = r <= a ? pi : std::asin(a / r);
  const auto turned = [&](double t) { return along_ray(pi + sector * (2.0 * t - 1.0)); };
  return 2.0 * sector * integral(turned, cells) / (pi * modulus);
}

TEST(Hertz, PressureCarriesTheForce) {
  const Hertz hertz(rubber(3.0, 0.4), 2.0);
  const double delta = 0.01, a = hertz.contact_radius(delta);
  const double force =
      a * integral([&](double t) { return 2 * pi * a * t * hertz.pressure(a * t, delta); }, 20000);
  EXPECT_NEAR(force / hertz.force(delta), 1.0, 1e-6);
  EXPECT_NEAR(hertz.max_pressure(delta), 1.5 * hertz.force(delta) / (pi * a * a), 1e-14);
}

TEST(Hertz, PressureMovesTheSurfaceOntoThePlane) {
  const double modulus = 3.0 / (1.0 - 0.4 * 0.4), radius = 2.0, delta = 0.02;
  const Hertz hertz(rubber(3.0, 0.4), radius);
  const double a = hertz.contact_radius(delta);
  for (const double r : {0.0, 0.5 * a, 0.9 * a})
    EXPECT_NEAR((delta - r * r / (2.0 * radius)) / boussinesq(hertz, modulus, r, delta, 400), 1.0,
                1e-5);
  for (const double r : {1.3 * a, 3.0 * a})  // outside a gap stays
    EXPECT_GT(boussinesq(hertz, modulus, r, delta, 400), delta - r * r / (2.0 * radius));
}

TEST(Hertz, SurfaceFarAwaySeesAPointForce) {
  const double modulus = 3.0 / (1.0 - 0.1 * 0.1);
  const Hertz hertz(rubber(3.0, 0.1), 1.0);
  const double delta = 1e-3, r = 50.0 * hertz.contact_radius(delta);
  const double point = hertz.force(delta) / (pi * modulus * r);
  EXPECT_NEAR(boussinesq(hertz, modulus, r, delta, 400) / point, 1.0, 1e-3);
}

TEST(Hertz, ScalesWithIndentationRadiusAndModulus) {
  const Hertz reference(rubber(3.0, 0.4), 2.0), larger(rubber(3.0, 0.4), 8.0);
  const Hertz harder(rubber(30.0, 0.4), 2.0);
  const double d = 0.003;
  EXPECT_NEAR(reference.force(4.0 * d), 8.0 * reference.force(d), 1e-14);
  EXPECT_NEAR(reference.contact_radius(4.0 * d), 2.0 * reference.contact_radius(d), 1e-15);
  EXPECT_NEAR(reference.max_pressure(4.0 * d), 2.0 * reference.max_pressure(d), 1e-14);
  EXPECT_NEAR(larger.force(d), 2.0 * reference.force(d), 1e-14);
  EXPECT_NEAR(larger.max_pressure(d), 0.5 * reference.max_pressure(d), 1e-14);
  EXPECT_NEAR(harder.force(d), 10.0 * reference.force(d), 1e-13);
  EXPECT_NEAR(harder.contact_radius(d), reference.contact_radius(d), 1e-16);
  EXPECT_EQ(reference.force(0.0), 0.0);
  EXPECT_EQ(reference.pressure(0.0, 0.0), 0.0);
}

TEST(Hertz, KnownNumber) {
  // E* = 49 gf/cm² for E = 40, nu = 3/7: F = 4/3 · 49 · 0.01^1.5 gf at R = 1 cm, delta = 0.01 cm
  const Hertz hertz(rubber(40.0, 3.0 / 7.0), 1.0);
  EXPECT_NEAR(hertz.force(0.01), 0.196 / 3.0, 1e-14);
}

TEST(Hertz, InversesUndo) {
  const Hertz hertz(rubber(3.0, -0.2), 0.7);
  for (const double delta : {0.0, 1e-6, 0.02}) {
    EXPECT_NEAR(hertz.indentation_at_force(hertz.force(delta)), delta, 1e-15);
  }
}

TEST(Hertz, RefusesWhatMeansNothing) {
  EXPECT_THROW_SAYING(Hertz(rubber(1.0, 0.3), 0.0), InvalidInput, "radius");
  EXPECT_THROW_SAYING(Hertz(rubber(1.0, 0.5), 1.0), InvalidInput, "rubber.shear_modulus");
  const Hertz hertz(rubber(1.0, 0.3), 1.0);
  EXPECT_THROW_SAYING(hertz.force(-0.1), InvalidInput, "indentation");
  EXPECT_THROW_SAYING(hertz.contact_radius(NAN), InvalidInput, "indentation");
  EXPECT_THROW_SAYING(hertz.pressure(-1.0, 0.1), InvalidInput, "r = -1");
  EXPECT_THROW_SAYING(hertz.indentation_at_force(-1.0), InvalidInput, "force");
}

}  // namespace
