#include "meshes/press/contact_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "meshes/tables/table_rows.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using meshes::ContactPoint;
using meshes::Vector3;

namespace {

ContactPoint point_at(const Vector3& place, const Vector3& normal, const Vector3& force) {
  ContactPoint point{.sample = 3, .indentation = 1e-3, .place = place, .area = 2e-7};
  point.normal = normal.normalized();
  point.set_force(force);
  return point;
}

const ContactPoint some = point_at({1e-3, 2e-3, 9e-3}, {0.1, 0.2, -1.0}, {1e-3, -2e-3, -9e-3});

const std::vector<ContactPoint> one = {some};

TEST(ContactField, TractionsAreThoseOfTheForce) {
  EXPECT_NEAR((some.force() - Vector3(1e-3, -2e-3, -9e-3)).norm(), 0.0, 1e-17);
  EXPECT_NEAR(some.shear.dot(some.normal), 0.0, 1e-9 * some.normal_traction);
  EXPECT_GT(some.normal_traction, 0.0);
}

/// About the centre of pressure: wherever the field lies, and whatever pull in proportion to the
/// pressures goes through that centre, the torque is that of what turns about it.
TEST(ContactField, SpinIsAboutTheCentreOfPressure) {
  const auto turned = [](const Vector3& away, double pull) {
    std::vector<ContactPoint> field;
    double torque = 0.0;
    for (int i = 0; i < 8; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / 8, push = i % 2 == 0 ? 2e-3 : 1e-3;
      const Vector3 arm(1e-3 * std::cos(angle), 1e-3 * std::sin(angle), 0.0);
      const Vector3 rub = 0.3 * push * Vector3(-std::sin(angle), std::cos(angle), 0.0);
      field.push_back(
          point_at(away + arm, -Vector3::UnitZ(), rub + Vector3(pull * push, 0.0, -push)));
      torque += arm.cross(rub).z();
    }
    EXPECT_NEAR(std::abs(meshes::spin_torque(field)), torque, 1e-9 * torque);
    return meshes::spin_torque(field);
  };
  const double here = turned(Vector3(0.0, 0.0, 9e-3), 0.0);
  EXPECT_NEAR(turned(Vector3(3e-3, -2e-3, 9e-3), 0.4), here, 1e-9 * std::abs(here));
}

/// Mirrored parts have no force across their planes, and what one image turns the other undoes.
TEST(ContactField, ImagesBearTheirShare) {
  const std::vector<ContactPoint> half = meshes::unfolded(one, 2),
                                  quarter = meshes::unfolded(one, 4);
  ASSERT_EQ(half.size(), 2u);
  ASSERT_EQ(quarter.size(), 4u);
  const auto of_half = meshes::sums_of(half, {0.0, 0.0, -0.03}),
             of_quarter = meshes::sums_of(quarter, {0.0, 0.0, -0.03});
  EXPECT_NEAR((of_half.force - Vector3(2e-3, 0.0, -18e-3)).norm(), 0.0, 1e-16);
  EXPECT_NEAR(of_half.torque.x(), 0.0, 1e-18);
  EXPECT_NEAR(of_half.torque.z(), 0.0, 1e-18);
  EXPECT_NEAR(of_half.torque.y(), 2.0 * (0.039 * 1e-3 + 1e-3 * 9e-3), 1e-17);
  EXPECT_NEAR((of_quarter.force - Vector3(0.0, 0.0, -36e-3)).norm(), 0.0, 1e-16);
  EXPECT_NEAR(of_quarter.torque.norm(), 0.0, 1e-18);
}

/// A node on a mirror plane bears half: with its image it is one point with all.
TEST(ContactField, APointOnAMirrorPlaneIsOne) {
  const ContactPoint on_y = point_at({1e-3, 0.0, 9e-3}, {0.1, 0.0, -1.0}, {1e-3, 0.0, -9e-3}),
                     middle = point_at({0.0, 1e-17, 9e-3}, {0.0, 0.0, -1.0}, {0.0, 0.0, -1e-3});
  const auto field = meshes::unfolded(std::vector<ContactPoint>{on_y, middle}, 4);
  ASSERT_EQ(field.size(), 3u);
  const auto sums = meshes::sums_of(field, Vector3::Zero());
  EXPECT_NEAR((sums.force - Vector3(0.0, 0.0, -40e-3)).norm(), 0.0, 1e-16);
  EXPECT_EQ(field[0].normal_traction, on_y.normal_traction);
  EXPECT_EQ(field[0].area, 2.0 * on_y.area);
  EXPECT_EQ(field[1].area, 4.0 * middle.area);
}

TEST(ContactField, ARingIsEvenAllAround) {
  const ContactPoint ring = point_at({2e-3, 0.0, 9e-3}, {0.3, 0.0, -1.0}, {2e-3, 1e-3, -9e-3});
  const std::vector<ContactPoint> points = meshes::turned_around(ring, 24);
  ASSERT_EQ(points.size(), 24u);
  for (const ContactPoint& point : points) {
    EXPECT_NEAR(point.place.head<2>().norm(), 2e-3, 1e-17);
    EXPECT_NEAR(point.normal.dot(point.place), ring.normal.dot(ring.place), 1e-16);
    EXPECT_EQ(point.normal_traction, ring.normal_traction);
  }
  const auto sums = meshes::sums_of(points, Vector3::Zero());
  EXPECT_NEAR((sums.force - Vector3(0.0, 0.0, -9e-3)).norm(), 0.0, 1e-16);
  EXPECT_NEAR((sums.torque - Vector3(0.0, 0.0, 2e-3 * 1e-3)).norm(), 0.0, 1e-18);  // twisted
  EXPECT_NEAR(meshes::centre_of_pressure(points).head<2>().norm(), 0.0, 1e-17);
}

TEST(ContactField, IsTakenApartBySamples) {
  EXPECT_TRUE(meshes::samples_of(std::vector<ContactPoint>()).empty());
  std::vector<ContactPoint> field;
  meshes::add_sample(meshes::unfolded(one, 2), 2, 2e-3, field);
  meshes::add_sample(one, 5, 3e-3, field);
  const auto samples = meshes::samples_of(field);
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_EQ(samples[0].size(), 2u);
  EXPECT_EQ(samples[1].size(), 1u);
  EXPECT_EQ(samples[1].front().sample, 5);
}

TEST(ContactField, IsReadAsItWasWritten) {
  const TemporaryFolder folder;
  std::vector<ContactPoint> field;
  meshes::add_sample(one, 1, 1e-3, field);
  meshes::add_sample(meshes::unfolded(one, 2), 2, 2e-3, field);
  field.back().state = meshes::ContactState::slip;
  meshes::write_rows(field, folder / "contact_field.csv");
  const auto read = meshes::read_rows<ContactPoint>(folder / "contact_field.csv");
  ASSERT_EQ(read.size(), 3u);
  EXPECT_EQ(read[2].sample, 2);
  EXPECT_EQ(read[2].indentation, 2e-3);
  EXPECT_EQ(read[2].place, field[2].place);
  EXPECT_EQ(read[2].force(), field[2].force());
  EXPECT_EQ(read[2].state, meshes::ContactState::slip);
  EXPECT_EQ(read[0].state, meshes::ContactState::stick);
}

}  // namespace
