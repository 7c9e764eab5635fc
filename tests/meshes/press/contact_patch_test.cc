#include "meshes/press/contact_patch.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

using namespace fingertip;
using meshes::ContactPatch;
using meshes::ContactPoint;
using meshes::LoadedPoint;

namespace {

/// Forces of an elliptic contact with half axes A and B whose pressure is Hertz's times a random
/// factor of mean 1, on a square raster.
std::vector<LoadedPoint> hertzian_points(double A, double B, double raster, double noise) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> uniform(1.0 - noise, 1.0 + noise);
  std::vector<LoadedPoint> points;
  const int n = int(1.5 * std::max(A, B) / raster);
  for (int i = -n; i <= n; ++i) {
    for (int j = -n; j <= n; ++j) {
      const Eigen::Vector2d place((i + 0.5) * raster, (j + 0.5) * raster);
      const double inside = 1.0 - std::pow(place.x() / A, 2) - std::pow(place.y() / B, 2);
      const double force = std::sqrt(std::max(inside, 0.0)) * raster * raster * uniform(generator);
      points.push_back({place + Eigen::Vector2d(0.3, -0.2), force, raster * raster});
    }
  }
  return points;
}

ContactPatch patch_of(const std::vector<LoadedPoint>& points, int sectors = 1) {
  meshes::ForceMoments sums;
  for (const LoadedPoint& point : points) sums.add(point);
  return contact_patch(sums, sectors);
}

/// As if each point hung on a particle of its own, for those who know what particles bear and
/// whether all points are pushed.
ContactPatch judged(const std::vector<LoadedPoint>& points, double bare = 1.0) {
  const ContactPatch patch = patch_of(points);
  std::vector<meshes::PatchLoad> loads;
  for (const LoadedPoint& point : points)
    loads.push_back({point.force, point.area * patch.max_pressure * patch.profile(point.place)});
  return patch.judged_by(loads, bare);
}

}  // namespace

TEST(ContactPatch, MeasuresHertzThroughNoise) {
  const auto smooth = patch_of(hertzian_points(1.0, 1.0, 0.05, 0.0));
  EXPECT_NEAR(smooth.radius, 1.0, 3e-3);
  EXPECT_NEAR(smooth.max_pressure, 1.0, 0.01);
  const auto rough = patch_of(hertzian_points(1.4, 0.8, 0.05, 1.0));
  EXPECT_NEAR(rough.radius, std::sqrt(1.4 * 0.8), 0.03);
  EXPECT_NEAR(rough.max_pressure, 1.0, 0.05);
}

/// The continuum at large strain: law A, sticking, 0.3 cm deep, from axisymmetric finite elements.
/// The pressure has a peak in the middle; Hertz's moment of it is 5 % too small a radius.
TEST(ContactPatch, MeasuresAPeakedPressure) {
  constexpr std::array<double, 8> at = {0.0, 0.25, 0.5, 0.75, 0.9, 0.95, 0.98, 1.0};
  constexpr std::array<double, 8> pressure = {1.0, 0.896, 0.666, 0.416, 0.248, 0.175, 0.117, 0.0};
  std::vector<LoadedPoint> points;
  constexpr double raster = 0.02;
  for (double x = raster / 2; x < 1.0; x += raster)
    for (double y = raster / 2; y < 1.0; y += raster) {
      const double r = std::hypot(x, y);
      if (r >= 1.0) continue;
      const std::size_t k = std::size_t(std::upper_bound(at.begin(), at.end(), r) - at.begin());
      // p² is nearly linear in r².
      const double share =
          (r * r - at[k - 1] * at[k - 1]) / (at[k] * at[k] - at[k - 1] * at[k - 1]);
      const double square =
          (1.0 - share) * std::pow(pressure[k - 1], 2) + share * std::pow(pressure[k], 2);
      points.push_back({{x, y}, std::sqrt(square) * raster * raster, raster * raster});
    }
  const auto patch = patch_of(points, 4);
  EXPECT_NEAR(patch.radius, 1.0, 0.01);
  EXPECT_NEAR(patch.max_pressure, 1.0, 0.02);
}

/// Pads, a ring and the face of a block bear alike all over. A turned ellipse is one.
TEST(ContactPatch, TellsWhatIsNoEllipse) {
  constexpr double raster = 0.1;
  const auto where = [](const std::function<bool(double, double)>& bears) {
    std::vector<LoadedPoint> points;
    for (double x = -10.0 + raster / 2; x < 10.0; x += raster)
      for (double y = -10.0 + raster / 2; y < 10.0; y += raster)
        if (bears(x, y))
          points.push_back({{x + 3.0, y - 1.0}, 5.0 * raster * raster, raster * raster});
    return judged(points);
  };
  const auto pads =
                 where([](double x, double y) { return std::abs(x) > 6.0 && std::abs(y) < 5.0; }),
             face =
                 where([](double x, double y) { return std::abs(x) < 3.0 && std::abs(y) < 5.0; }),
             disc = where([](double x, double y) { return std::hypot(x, y) < 5.0; }),
             ring = where([](double x, double y) {
               return std::hypot(x, y) > 5.0 && std::hypot(x, y) < 8.0;
             });
  for (const auto& [patch, area] :
       {std::pair(pads, 80.0), std::pair(face, 60.0), std::pair(disc, 25.0 * std::numbers::pi),
        std::pair(ring, 39.0 * std::numbers::pi)}) {
    EXPECT_NEAR(patch.radius, std::sqrt(area / std::numbers::pi), 2e-3 * patch.radius) << area;
    EXPECT_TRUE(std::isnan(patch.max_pressure)) << area;
  }
  std::vector<LoadedPoint> turned = hertzian_points(1.6, 0.8, 0.05, 0.0);
  for (LoadedPoint& point : turned) point.place = Eigen::Rotation2Dd(0.5) * point.place;
  const auto ellipse = judged(turned);
  EXPECT_NEAR(ellipse.radius, std::sqrt(1.6 * 0.8), 5e-3);
  EXPECT_NEAR(ellipse.max_pressure, 1.0, 0.02);
}

/// The pressure under a soft pad is the more like Hertz's the nearer its rubber is to
/// incompressible; but the face ends.
TEST(ContactPatch, TellsAFaceWhateverItsPressure) {
  constexpr double raster = 0.1;
  for (const double edge : {1.0, 0.7, 0.4}) {
    std::vector<LoadedPoint> points;
    for (double x = -6.0 + raster / 2; x < 6.0; x += raster)
      for (double y = -6.0 + raster / 2; y < 6.0; y += raster) {
        const double s = (x * x + y * y) / 25.0;
        if (s < 1.0)
          points.push_back({{x, y}, (1.0 - (1.0 - edge) * s) * raster * raster, raster * raster});
      }
    const ContactPatch patch = judged(points, 0.0);
    EXPECT_FALSE(patch.is_ellipse()) << edge;
    EXPECT_NEAR(patch.radius, 5.0, 0.02) << edge;
    EXPECT_GT(std::abs(patch_of(points).radius - 5.0), 0.1) << edge;
  }
}

/// Where no point lies in its middle, Hertz's pressure there follows from those around it.
TEST(ContactPatch, FindsTheLargestPressureBetweenPoints) {
  const auto field_of = [](const std::vector<LoadedPoint>& points) {
    std::vector<ContactPoint> field;
    for (const LoadedPoint& loaded : points) {
      if (!(loaded.force > 0.0)) continue;
      ContactPoint& point = field.emplace_back();
      point.place.head<2>() = loaded.place;
      point.area = loaded.area;
      point.normal_traction = loaded.force / loaded.area;
    }
    return field;
  };
  const auto field = field_of(hertzian_points(1.0, 1.0, 0.3, 0.0));
  double largest = 0.0;
  for (const ContactPoint& point : field) largest = std::max(largest, point.normal_traction);
  EXPECT_LT(largest, 0.98);
  EXPECT_NEAR(largest_pressure(field), 1.0, 0.01);
  EXPECT_EQ(largest_pressure(std::vector<ContactPoint>{}), 0.0);
  std::vector<ContactPoint> face = field_of(hertzian_points(1.0, 1.0, 0.02, 0.0));
  for (ContactPoint& point : face) point.normal_traction = 2.0 + point.place.x();
  EXPECT_EQ(largest_pressure(face), std::ranges::max(face, {}, [](const ContactPoint& point) {
                                      return point.normal_traction;
                                    }).normal_traction);
}

TEST(ContactPatch, SectorsAreMirrored) {
  std::vector<LoadedPoint> whole, half, quarter;
  for (LoadedPoint point : hertzian_points(1.2, 0.9, 0.1, 0.0)) {
    point.place -= Eigen::Vector2d(0.3, -0.2);
    whole.push_back(point);
    if (point.place.y() < 0.0) continue;
    half.push_back(point);
    if (point.place.x() > 0.0) quarter.push_back(point);
  }
  const auto expected = patch_of(whole);
  for (const auto& part : {patch_of(half, 2), patch_of(quarter, 4)}) {
    EXPECT_NEAR(part.radius, expected.radius, 1e-12);
    EXPECT_NEAR(part.max_pressure, expected.max_pressure, 1e-12);
  }
}

TEST(ContactPatch, NothingAndASinglePoint) {
  EXPECT_EQ(patch_of(std::vector<LoadedPoint>{}, 4).radius, 0.0);
  EXPECT_EQ(patch_of(std::vector<LoadedPoint>{{{0.0, 0.0}, 0.0, 1.0}}).max_pressure, 0.0);
  const auto single = patch_of(std::vector<LoadedPoint>{{{0.2, 0.1}, 3.0, 2.0}});
  EXPECT_NEAR(single.radius, std::sqrt(5.0 * 2.0 / (4.0 * std::numbers::pi)), 1e-14);
  EXPECT_NEAR(single.max_pressure, 1.5 * 3.0 / (std::numbers::pi * single.radius * single.radius),
              1e-14);
}
