// Obstacles: distance, height, and where they first touch a finger.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "meshes/press/obstacle.h"
#include "meshes/press/press_protocol.h"
#include "meshes/shape/geometry.h"
#include "tests/expectations.h"
#include "tests/fingers.h"

using namespace fingertip::meshes;

namespace {

using Eigen::Vector2d;

Obstacle obstacle(ObstacleShape shape, double radius = 4e-3, double offset = 0.0,
                  ObstacleAxis along = ObstacleAxis::y) {
  return {.shape = shape, .radius = radius, .along = along, .offset = offset};
}

const std::vector<Obstacle> curved = {
    obstacle(ObstacleShape::sphere, 4e-3, 1e-3),
    obstacle(ObstacleShape::cylinder, 4e-3, 1e-3),
    obstacle(ObstacleShape::cylinder, 4e-3, 1e-3, ObstacleAxis::x),
    obstacle(ObstacleShape::edge, 1.5e-3, 1e-3),
    obstacle(ObstacleShape::edge, 1.5e-3, 1e-3, ObstacleAxis::x),
};

/// Places around the top, some inside, some beside, none where the surface has a corner.
std::vector<Vector3> places() {
  std::vector<Vector3> all;
  for (const double x : {-5.31e-3, -1.12e-3, 0.43e-3, 2.24e-3, 6.15e-3})
    for (const double y : {-4.71e-3, 0.36e-3, 1.94e-3})
      for (const double z : {-2.13e-3, -0.27e-3, 0.68e-3, 5.1e-3}) all.emplace_back(x, y, z);
  return all;
}

/// The surface as a curve (across, z): an arc around the top, and the faces of an edge.
Vector2d outline(const Obstacle& o, double t) {
  const double half = o.shape == ObstacleShape::edge ? std::numbers::pi / 4 : std::numbers::pi;
  const double angle = std::clamp(t, -half, half), beyond = t - angle;  // in radians of arc
  const Vector2d on_arc(o.radius * std::sin(angle), o.radius * (std::cos(angle) - 1.0));
  const Vector2d down(std::cos(angle) * (beyond < 0 ? -1.0 : 1.0), -std::abs(std::sin(angle)));
  return on_arc + o.radius * std::abs(beyond) * down;
}

/// Distance from the curve, negative below its height, by looking at very many of its points.
double searched(const Obstacle& o, const Vector3& place) {
  const double dx = place.x() - o.offset, dy = place.y();
  const double across = o.shape == ObstacleShape::sphere ? std::hypot(dx, dy)
                        : o.along == ObstacleAxis::x     ? dy
                                                         : dx;
  const Vector2d at(across, place.z());
  const double end = o.shape == ObstacleShape::edge ? 10.0 : std::numbers::pi;
  const int count = 100000;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= count; ++i)
    least = std::min(least, (outline(o, end * (2.0 * i / count - 1.0)) - at).norm());
  const bool inside = o.shape == ObstacleShape::edge
                          ? place.z() < height(o, place)
                          : std::hypot(across, place.z() + o.radius) < o.radius;
  return inside ? -least : least;
}

TEST(Obstacle, DistanceIsThatOfItsSurface) {
  for (const Obstacle& o : curved)
    for (const Vector3& place : places())
      EXPECT_NEAR(hit(o, place).gap, searched(o, place), 2e-8)
          << name(o.shape) << place.transpose();
  EXPECT_EQ(hit({}, Vector3(1.0, 2.0, -3e-3)).gap, -3e-3);
}

TEST(Obstacle, NormalAndCurvatureAreDerivatives) {
  const double h = 1e-8;
  for (const Obstacle& o : curved)
    for (const Vector3& place : places()) {
      const Vector3 normal(hit(o, place).normal);
      const Eigen::Matrix3d bend = curvature(o, place);
      EXPECT_NEAR(normal.norm(), 1.0, 1e-14);
      for (int c = 0; c < 3; ++c) {
        const Vector3 step = h * Vector3::Unit(c);
        const auto before = hit(o, place - step), after = hit(o, place + step);
        EXPECT_NEAR((after.gap - before.gap) / (2 * h), normal[c], 1e-7);
        const Vector3 change = (Vector3(after.normal) - Vector3(before.normal)) / (2 * h);
        EXPECT_LT((change - bend.col(c)).norm(), 1e-6 * (1.0 / o.radius));
      }
    }
}

TEST(Obstacle, HeightIsWhereTheDistanceVanishes) {
  for (const Obstacle& o : curved)
    for (const Vector3& place : places()) {
      Vector3 on(place.x(), place.y(), height(o, place));
      if (o.shape != ObstacleShape::edge && !(on.z() > -o.radius)) continue;  // beside it
      EXPECT_NEAR(hit(o, on).gap, 0.0, 1e-16);
    }
  EXPECT_EQ(height(curved[0], {1e-3, 0.0, 0.0}), 0.0);
  EXPECT_LT(height(curved[0], {6e-3, 0.0, 0.0}), -0.9);
}

/// Two balls side by side: their centres are R + radius apart.
/// None where a point goes along with the obstacle, all where it stays, a part where it follows in
/// part or aslant, and never more than the way nor less than nothing.
TEST(Obstacle, FeetPassByWhatPointsDo) {
  EXPECT_EQ(fingertip::meshes::share_passed(0.0, 0.0, 3.0, 4.0), 0.0);
  EXPECT_EQ(fingertip::meshes::share_passed(3.0, 4.0, 3.0, 4.0), 1.0);
  EXPECT_DOUBLE_EQ(fingertip::meshes::share_passed(5.0, 0.0, 3.0, 4.0), 0.6);
  EXPECT_EQ(fingertip::meshes::share_passed(6.0, 8.0, 3.0, 4.0), 1.0);
  EXPECT_EQ(fingertip::meshes::share_passed(-3.0, -4.0, 3.0, 4.0), 0.0);
  EXPECT_EQ(fingertip::meshes::share_passed(1.0, 1.0, 0.0, 0.0), 0.0);
}

TEST(Obstacle, FirstTouchOfBallsIsThatOfTheirCentres) {
  const Geometry dome;
  const double R = dome.tip_radius, radius = 4e-3;
  for (const double offset : {0.0, 2e-3, -6e-3, 9e-3})
    for (const double tilt : {0.0, 0.3}) {
      const double expected = std::sqrt(std::pow(R + radius, 2) - offset * offset) - radius;
      for (const ObstacleShape shape : {ObstacleShape::sphere, ObstacleShape::cylinder})
        EXPECT_NEAR(first_touch(dome, tilt, obstacle(shape, radius, offset)), expected, 1e-12)
            << offset << ' ' << tilt;
      EXPECT_NEAR(first_touch(dome, tilt,
                              obstacle(ObstacleShape::cylinder, radius, offset, ObstacleAxis::x)),
                  R, 1e-12);
    }
  EXPECT_EQ(first_touch(dome, 0.0, {}), R);
  EXPECT_NEAR(first_touch(dome, 0.0, obstacle(ObstacleShape::sphere, 0.2e-3, 4.321e-3)),
              std::sqrt(10.2e-3 * 10.2e-3 - 4.321e-3 * 4.321e-3) - 0.2e-3, 1e-12);
}

TEST(Obstacle, FirstTouchOfAnEdgeBesideTheAxis) {
  // The dome's slope is that of the face where its normal is at 45 degrees: there it touches.
  const Geometry dome;
  const double R = dome.tip_radius, radius = 1e-3, offset = -12e-3, root = std::numbers::sqrt2;
  EXPECT_NEAR(first_touch(dome, 0.0, obstacle(ObstacleShape::edge, radius, offset)),
              root * R + offset + (root - 1.0) * radius, 1e-12);
}

TEST(Obstacle, IsRefusedWhereItMissesOrStartsInside) {
  const auto refusal = [](const Geometry& geometry, const Obstacle& o) {
    PressProtocol protocol;
    protocol.obstacle = o;
    const auto found = protocol.violations(geometry);
    return found.empty() ? std::string() : found.front().key + ": " + found.front().rule;
  };
  const Geometry dome;
  for (const Obstacle& o : curved) EXPECT_EQ(refusal(dome, o), "");
  EXPECT_TRUE(says(refusal(dome, obstacle(ObstacleShape::sphere, 4e-3, 15e-3)), "misses"));
  EXPECT_TRUE(says(refusal(dome, obstacle(ObstacleShape::sphere, -1.0)), "obstacle.radius"));
  EXPECT_TRUE(says(refusal(dome, obstacle(ObstacleShape::sphere, 4e-3, NAN)), "obstacle.offset"));
  // Of this finger the cap alone may touch: a ball beside it comes to the side first.
  std::vector<ProfileCorner> corners = fingers::solid();
  corners[0].surface = ProfileSurface::free;
  corners[0].curve = ProfileCurve::straight;
  const double up = 0.0125 + 0.0125 * std::sin(1.0), across = 0.0125 * std::cos(1.0);
  corners[1].surface = ProfileSurface::free;
  corners.insert(corners.begin() + 2, {.r = across,
                                       .z = up,
                                       .surface = ProfileSurface::contact,
                                       .curve = ProfileCurve::arc,
                                       .centre_r = 0.0,
                                       .centre_z = 0.0125});
  const Geometry capped = Geometry::of_profile(corners);
  EXPECT_EQ(refusal(capped, obstacle(ObstacleShape::sphere, 4e-3)), "");
  EXPECT_TRUE(says(refusal(capped, obstacle(ObstacleShape::sphere, 4e-3, 11e-3)), "starts inside"));
}

TEST(Obstacle, AndTipAreLikeOneBallOnAPlane) {
  const Geometry dome;
  const auto shape = shape_of(dome);
  const double R = dome.tip_radius;
  EXPECT_DOUBLE_EQ(relative_radius(*shape, {}), R);
  EXPECT_DOUBLE_EQ(relative_radius(*shape, obstacle(ObstacleShape::sphere, R)), R / 2);
  EXPECT_DOUBLE_EQ(relative_radius(*shape, obstacle(ObstacleShape::cylinder, R)),
                   R / std::numbers::sqrt2);
}

TEST(Obstacle, LargeBallsArePlanes) {
  const Obstacle large = obstacle(ObstacleShape::sphere, 1e3);
  for (const Vector3& place : places()) EXPECT_NEAR(hit(large, place).gap, place.z(), 1e-7);
}

}  // namespace
