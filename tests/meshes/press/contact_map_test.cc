#include "meshes/press/contact_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

using namespace fingertip;
using meshes::ContactDifference;
using meshes::ContactPoint;
using meshes::Vector3;

namespace {

constexpr double pi = std::numbers::pi;
using Field = std::vector<ContactPoint>;

double hertz(double r) {
  return std::sqrt(std::max(1.0 - r * r, 0.0));
}

/// As the meridian tells its rings, the pressure `peak` times Hertz's, the shear `friction` times
/// that along x.
Field rings(int count, double peak = 1.0, double friction = 0.0) {
  Field field;
  for (int i = 0; i < count; ++i) {
    const double r = (i + 0.5) / count;
    ContactPoint ring;
    ring.place = {r, 0.0, 0.0};
    ring.area = 2.0 * pi * r / count;
    ring.normal_traction = peak * hertz(r);
    for (ContactPoint& point : turned_around(ring, 24)) {
      point.shear = {friction * point.normal_traction, 0.0, 0.0};
      field.push_back(point);
    }
  }
  return field;
}

/// Points of a grid, moved by chance, about a centre.
Field scattered(double spacing, const Vector3& centre) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-0.2, 0.2);
  Field field;
  const int cells = int(1.1 / spacing);
  for (int i = -cells; i <= cells; ++i)
    for (int j = -cells; j <= cells; ++j) {
      const Vector3 place((i + uniform(generator)) * spacing, (j + uniform(generator)) * spacing,
                          0.0);
      if (place.norm() >= 1.0) continue;
      ContactPoint& point = field.emplace_back();
      point.place = centre + place;
      point.area = spacing * spacing;
      point.normal_traction = hertz(place.norm());
    }
  return field;
}

ContactDifference difference(const Field& field, const Field& first, Eigen::Index count = 80) {
  const std::array<std::span<const ContactPoint>, 2> both{field, first};
  const meshes::Raster raster = meshes::raster_around(both, count);
  return difference_of(contact_map(field, raster), contact_map(first, raster));
}

}  // namespace

/// The same pressure at other points is the same pressure.
TEST(ContactMap, DoesNotDependOnThePoints) {
  const ContactDifference d = difference(scattered(0.15, Vector3::Zero()), rings(12));
  EXPECT_LT(d.pressure_l2, 0.02);
  EXPECT_LT(std::abs(d.radius), 0.01);
  EXPECT_LT(std::abs(d.spread), 0.01);
  EXPECT_LT(std::abs(d.peak), 0.03);
  EXPECT_LT(d.centre, 0.02);
  const ContactDifference fine = difference(scattered(0.05, Vector3::Zero()), rings(40));
  EXPECT_LT(fine.pressure_l2, 0.6 * d.pressure_l2);
  // And force is kept.
  const Field field = rings(40);
  const std::array<std::span<const ContactPoint>, 1> own{field};
  const auto map = contact_map(field, meshes::raster_around(own, 100));
  EXPECT_NEAR(map.pressure.sum() * std::pow(map.raster.step, 2), 2.0 * pi / 3.0, 0.01);
  EXPECT_NEAR(map.touches.sum() * std::pow(map.raster.step, 2), pi, 0.02);
}

/// ∫ p² = p0² A/2 for Hertz.
TEST(ContactMap, TellsWhatDiffers) {
  const Field first = rings(30, 1.0, 0.2);
  const ContactDifference none = difference(first, first);
  EXPECT_EQ(none.pressure_l2, 0.0);
  EXPECT_EQ(none.centre, 0.0);
  const ContactDifference more = difference(rings(30, 1.1, 0.3), first);
  EXPECT_NEAR(more.pressure_l2, 0.1 * std::sqrt(0.5), 1e-3);
  EXPECT_NEAR(more.shear_l2, (1.1 * 0.3 - 0.2) * std::sqrt(0.5), 2e-3);
  EXPECT_NEAR(more.peak, 0.1, 1e-6);
  EXPECT_NEAR(more.radius, 0.0, 1e-6);
  Field wide = first;
  for (ContactPoint& point : wide) {
    point.place = 1.2 * point.place + Vector3(0.1, -0.05, 0.0);
    point.area *= 1.44;
  }
  const ContactDifference grown = difference(wide, first, 150);
  EXPECT_NEAR(grown.radius, 0.2, 0.01);
  EXPECT_NEAR(grown.spread, 0.2, 0.005);
  EXPECT_NEAR(grown.centre, std::hypot(0.1, 0.05), 2e-3);
  EXPECT_NEAR(grown.peak, 0.0, 5e-3);
}

/// Of a quarter, with points on its mirror planes, a shear that is linear is linear on them, too.
TEST(ContactMap, GoesThroughMirrorPlanes) {
  Field quarter;
  constexpr double spacing = 0.1;
  for (int i = 0; i <= 10; ++i)
    for (int j = 0; j <= 10; ++j) {
      const double r = std::hypot(i, j) * spacing;
      if (r >= 1.0) continue;
      ContactPoint& point = quarter.emplace_back();
      point.place = {i * spacing, j * spacing, 0.0};
      point.area = spacing * spacing * (i == 0 ? 0.5 : 1.0) * (j == 0 ? 0.5 : 1.0);
      point.normal_traction = hertz(r);
      point.shear = {0.3 * i * spacing, 0.3 * j * spacing, 0.0};
    }
  const Field field = meshes::unfolded(quarter, 4);
  const std::array<std::span<const ContactPoint>, 1> own{field};
  const auto map = contact_map(field, meshes::raster_around(own, 81));
  for (Eigen::Index i = 0; i < 81; ++i) {
    const double x = map.raster.x(i);
    if (std::abs(x) > 0.8) continue;
    EXPECT_NEAR(map.shear_x(i, 40), 0.3 * x, 1e-9) << x;
    EXPECT_NEAR(map.pressure(i, 40), hertz(x), 0.01) << x;
  }
}

/// Two pads, each alike all over; between them nothing bears.
TEST(ContactMap, OfWhatIsNoEllipse) {
  Field pads;
  for (int i = -20; i < 20; ++i)
    for (int j = -10; j < 10; ++j) {
      if (std::abs(i + 0.5) < 8.0) continue;
      ContactPoint& point = pads.emplace_back();
      point.place = {0.1 * (i + 0.5), 0.1 * (j + 0.5), 0.0};
      point.area = 0.01;
      point.normal_traction = i < 0 ? 5.0 : 1.0;
    }
  const std::array<std::span<const ContactPoint>, 1> own{pads};
  const auto map = contact_map(pads, meshes::raster_around(own, 81));
  for (Eigen::Index i = 0; i < 81; ++i) {
    const double x = std::abs(map.raster.x(i)), there = map.pressure(i, 40);
    if (x > 0.95 && x < 1.9) {
      EXPECT_NEAR(there, map.raster.x(i) < 0.0 ? 5.0 : 1.0, 1e-9) << x;
    }
    if (x > 2.0 || x < 0.65) {
      EXPECT_EQ(there, 0.0) << x;
    }
  }
}

/// A point or some in a line have no area.
TEST(ContactMap, OfFewPointsIsNothing) {
  Field field(3);
  for (std::size_t i = 0; i < field.size(); ++i) {
    field[i].place.x() = double(i);
    field[i].area = field[i].normal_traction = 1.0;
    const std::span<const ContactPoint> few(field.data(), i + 1);
    const std::array<std::span<const ContactPoint>, 2> both{few, few};
    const auto map = contact_map(few, meshes::raster_around(both, 10));
    EXPECT_EQ(map.pressure.maxCoeff(), 0.0);
    EXPECT_TRUE(std::isnan(difference_of(map, map).pressure_l2));
  }
  EXPECT_EQ(contact_map({}, meshes::Raster{{0.0, 0.0}, 0.1, 5}).pressure.sum(), 0.0);
}
