#include "calibration/press_fit/displacements.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

using namespace fingertip;
using calibration::distance_of;
using calibration::grid_scatter;
using meshes::Vector3;

namespace {

std::vector<Vector3> grid_of(int count) {
  std::vector<Vector3> points;
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j)
      for (int k = 0; k < count; ++k) points.emplace_back(i, j, k);
  return points;
}

/// A block squeezed along z that bulges.
Vector3 squeezed(const Vector3& at) {
  return {0.03 * at.x(), 0.03 * at.y() * (1.0 + at.x()), -0.1 * at.z()};
}

struct Field {
  std::vector<Vector3> places = grid_of(4), displacement;
  Field() {
    for (const Vector3& place : places) displacement.push_back(squeezed(place));
  }
  /// The same seen from a frame that has moved.
  std::vector<Vector3> seen(const Eigen::AngleAxisd& turn, const Vector3& shift) const {
    std::vector<Vector3> moved;
    for (std::size_t i = 0; i < places.size(); ++i)
      moved.push_back(turn * (places[i] + displacement[i]) + shift - places[i]);
    return moved;
  }
};

}  // namespace

TEST(Displacements, AFrameThatMovedTellsTheSame) {
  const Field field;
  const auto seen = field.seen(Eigen::AngleAxisd(0.3, Vector3(1, 2, -1).normalized()), {4, -1, 2});
  const auto found = distance_of(field.places, seen, field.displacement);
  EXPECT_LT(found.largest, 1e-13);
  EXPECT_NEAR(found.turn, 0.3, 1e-13);
  EXPECT_NEAR(found.ratio, 1.0, 1e-13);
  for (std::size_t i = 0; i < seen.size(); ++i)
    EXPECT_LT((found.displacement[i] - field.displacement[i]).norm(), 1e-13);
}

TEST(Displacements, WhatIsStrainedStaysAndIsMeasured) {
  Field field;
  auto larger = field.displacement;
  for (Vector3& u : larger) u *= 1.0 + 1e-4;
  const auto found = distance_of(field.places, larger, field.displacement);
  EXPECT_NEAR(found.ratio, 1.0 + 1e-4, 1e-6);
  EXPECT_NEAR(found.rms, 1e-4 * found.size, 1e-7);  // a scale is no rotation
  // A point alone that is off moves the frame a little, itself most.
  larger = field.displacement;
  larger[17] += Vector3(0.5, 0.0, 0.0);
  const auto off = distance_of(field.places, larger, field.displacement);
  EXPECT_EQ(off.farthest, 17u);
  EXPECT_GT(off.largest, 0.45);
  EXPECT_LT(off.largest, 0.5);
}

TEST(Displacements, WhatWasNotMeasuredDoesNotCount) {
  Field field;
  auto seen = field.displacement;
  seen[3].setConstant(NAN);
  const auto found = distance_of(field.places, seen, field.displacement);
  EXPECT_LT(found.largest, 1e-13);
  EXPECT_TRUE(std::isnan(found.displacement[3].x()));
  for (Vector3& u : seen) u.setConstant(NAN);
  EXPECT_TRUE(std::isnan(distance_of(field.places, seen, field.displacement).rms));
}

TEST(Displacements, PointsOnALineLeaveARotationOpen) {
  std::vector<Vector3> line, rest(6, Vector3::Zero());
  for (int i = 0; i < 6; ++i) line.emplace_back(i, 2 * i, 0);
  EXPECT_TRUE(std::isnan(distance_of(line, rest, rest).rms));
}

TEST(Displacements, ScatterAboutAGrid) {
  const auto grid = grid_of(7);
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 0.2);
  const Eigen::AngleAxisd turn(0.2, Vector3(0, 1, 1).normalized());
  std::vector<Vector3> places;
  for (const Vector3& at : grid)
    places.push_back(turn * (10.1 * at) + Vector3(3, 2, 1) +
                     Vector3(normal(random), normal(random), normal(random)));
  const auto found = grid_scatter(grid, places);
  EXPECT_NEAR(found.pitch, 10.1, 0.01);
  EXPECT_NEAR(found.rms, 0.2 * std::sqrt(3.0), 0.02);
  EXPECT_GT(found.largest, found.rms);
}
