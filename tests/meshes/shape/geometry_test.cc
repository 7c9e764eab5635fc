#include "meshes/shape/geometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

using namespace fingertip::meshes;

namespace {

Vector3 random_point(std::mt19937& random, const Geometry& geometry) {
  std::uniform_real_distribution<double> across(-1.3 * geometry.tip_radius,
                                                1.3 * geometry.tip_radius);
  std::uniform_real_distribution<double> along(-1.3 * geometry.sleeve_length,
                                               1.3 * geometry.tip_radius);
  return {across(random), across(random), along(random)};
}

TEST(Geometry, VolumeAgreesWithMonteCarloOfThePapersSet) {
  const Geometry geometry;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double height = geometry.sleeve_length + geometry.tip_radius;
  const int throws = 400000;
  int hits = 0;
  for (int i = 0; i < throws; ++i) {
    const Vector3 w{geometry.tip_radius * (2.0 * unit(random) - 1.0),
                    geometry.tip_radius * (2.0 * unit(random) - 1.0),
                    -geometry.sleeve_length + height * unit(random)};
    hits += geometry.contains(w);
  }
  const double box = 4.0 * geometry.tip_radius * geometry.tip_radius * height;
  EXPECT_NEAR(box * hits / throws / geometry.tip_volume(), 1.0, 0.006);  // 4 standard deviations
}

TEST(Geometry, SignedDistanceIsNegativeExactlyInsideThePapersSet) {
  const Geometry geometry;
  std::mt19937 random(2);
  for (int i = 0; i < 20000; ++i) {
    const Vector3 w = random_point(random, geometry);
    EXPECT_EQ(geometry.signed_distance(w) < 0.0, geometry.contains(w)) << w.transpose();
  }
}

TEST(Geometry, SignedDistanceIsTheDistanceToTheNearestSurfacePoint) {
  const Geometry geometry;
  // The boundary as a dense cloud: body of revolution, so the half plane y = 0, x >= 0 suffices.
  std::vector<Vector3> boundary;
  const int n = 4000;
  for (int i = 0; i <= n; ++i) {
    const double s = double(i) / n, angle = s * std::acos(0.0);
    for (const double radius : {geometry.rod_radius, geometry.tip_radius}) {
      boundary.emplace_back(radius * std::cos(angle), 0.0, radius * std::sin(angle));
      boundary.emplace_back(radius, 0.0, -s * geometry.sleeve_length);
    }
    boundary.emplace_back(geometry.rod_radius + s * geometry.thickness(), 0.0,
                          -geometry.sleeve_length);
  }
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {
    const Vector3 w = random_point(random, geometry);
    if (Geometry::radial_distance(w) < geometry.rod_radius && w.z() < 0.0 &&
        w.z() < -0.9 * geometry.sleeve_length) {
      continue;  // inside the rod near its mouth the cloud's resolution dominates
    }
    const Vector3 half_plane{std::hypot(w.x(), w.y()), 0.0, w.z()};
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vector3& point : boundary) nearest = std::min(nearest, (half_plane - point).norm());
    EXPECT_NEAR(std::abs(geometry.signed_distance(w)), nearest, 2e-5) << w.transpose();
  }
}

TEST(Geometry, GradientOfSignedDistanceHasUnitLength) {
  const Geometry geometry;
  const Vector3 w{0.004, 0.003, 0.005};
  const double h = 1e-7;
  Vector3 gradient;
  for (int d = 0; d < 3; ++d) {
    const Vector3 step = h * Vector3::Unit(d);
    gradient[d] =
        (geometry.signed_distance(w + step) - geometry.signed_distance(w - step)) / (2 * h);
  }
  EXPECT_NEAR(gradient.norm(), 1.0, 1e-6);
}

TEST(Geometry, PointsOnTheOuterSurfaceBelongAndPointsOnTheBondDoNot) {
  const Geometry geometry;
  EXPECT_TRUE(geometry.contains({0.0, 0.0, geometry.tip_radius}));
  EXPECT_FALSE(geometry.contains({0.0, 0.0, geometry.rod_radius}));
  EXPECT_TRUE(geometry.contains({geometry.tip_radius, 0.0, -geometry.sleeve_length}));
  EXPECT_FALSE(geometry.contains({0.0, 0.0, geometry.tip_radius * (1 + 1e-12)}));
  EXPECT_TRUE(geometry.contains({0.0, 0.0, geometry.tip_radius * (1 + 1e-12)}, 1e-10));
}

TEST(Geometry, RefusesImpossibleSizesAndNamesTheKey) {
  const auto keys = [](const Geometry& geometry) {
    std::vector<std::string> found;
    for (const Violation& violation : geometry.violations()) found.push_back(violation.key);
    return found;
  };
  using Keys = std::vector<std::string>;
  EXPECT_EQ(keys({}), Keys{});
  EXPECT_EQ(keys({.rod_radius = 0.01}), Keys{"geometry.rod_radius"});
  EXPECT_EQ(keys({.tip_radius = std::nan("")}), Keys{"geometry.tip_radius"});
  EXPECT_EQ(keys({.sleeve_length = -1e-3}), Keys{"geometry.sleeve_length"});
  EXPECT_EQ(keys({.sleeve_length = 0.04}), Keys{"geometry.rod_length"});
  EXPECT_EQ(keys({.sleeve_length = 0.0}), Keys{});
}

}  // namespace
