#include "meshes/press/markers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "meshes/press/marker_measures.h"
#include "meshes/press/press_protocol.h"
#include "tests/expectations.h"
#include "tests/fingers.h"

using namespace fingertip::meshes;

namespace {

const Geometry dome;  // R = 10 mm on a rod of 5 mm, its end at z = -15 mm

/// What marker_at says against a place of the dome [m].
Violation refusal_of(const Vector3& place) {
  try {
    marker_at(*shape_of(dome), place);
  } catch (const InvalidInput& error) {
    return error.violations().front();
  }
  return {};
}

TEST(Markers, StayInTheRubber) {
  const auto shape = shape_of(dome);
  for (const Vector3& inside :
       {Vector3(0.0, 0.0, 8e-3), Vector3(-4e-3, 5e-3, 3e-3), Vector3(7e-3, 0.0, -12e-3)})
    EXPECT_EQ(marker_at(*shape, inside), inside);
  // Rounded to a hundredth of a millimetre a place on the sphere may lie outside.
  const Vector3 rounded(3.21e-3, -4.33e-3, 8.43e-3);
  ASSERT_GT(rounded.norm(), 10e-3);
  EXPECT_NEAR((marker_at(*shape, rounded) - 10e-3 * rounded.normalized()).norm(), 0.0, 1e-12);
}

TEST(Markers, AreRefusedOutsideWithTheNearestPlaceInside) {
  const Violation above = refusal_of({0.0, 8e-3, 9e-3});
  EXPECT_EQ(above.key, "sensor.markers");
  EXPECT_NE(above.rule.find("mm outside the finger"), std::string::npos) << above.rule;
  // 10/sqrt(145) of the way.
  EXPECT_NE(above.remedy.find("(0, 6.64364, 7.47409) mm"), std::string::npos) << above.remedy;
  const Violation in_rod = refusal_of({0.0, 0.0, 4e-3});
  EXPECT_NE(in_rod.rule.find("in the rod, 1 mm from the rubber"), std::string::npos) << in_rod.rule;
  EXPECT_NE(in_rod.remedy.find("(0, 0, 5) mm"), std::string::npos) << in_rod.remedy;
  EXPECT_NE(refusal_of({7e-3, 0.0, -16e-3}).rule.find("1 mm outside"), std::string::npos);
}

TEST(Markers, AreCheckedByEveryPress) {
  PressProtocol protocol;
  protocol.markers = {{0.0, 0.0, 8e-3}};
  EXPECT_TRUE(protocol.violations(dome).empty());
  protocol.markers = {{0.0, 0.0, 8e-3}, {0.0, 0.0, 4e-3}, {0.0, 0.0, unknown}};
  const auto found = protocol.violations(dome);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].key, "sensor.markers");
  EXPECT_EQ(found[1].rule, "a place is three finite numbers");
}

TEST(MarkerGrid, IsSquareAsSeenAlongTheAxis) {
  for (const double depth : {0.0, 1.5e-3}) {
    const double pitch = 0.8e-3;
    const auto markers = marker_grid(*shape_of(dome), pitch, depth);
    std::size_t expected = 0;  // within the 60 degrees
    for (int i = -20; i <= 20; ++i)
      for (int j = -20; j <= 20; ++j)
        if (std::hypot(i, j) * pitch < std::sqrt(0.75) * 10e-3) ++expected;
    EXPECT_EQ(markers.size(), expected);
    for (const Vector3& marker : markers) {
      EXPECT_NEAR(marker.norm(), 10e-3 - depth, 1e-9);
      const Vector3 above = 10e-3 / (10e-3 - depth) * marker / pitch;
      EXPECT_NEAR(above.x(), std::round(above.x()), 1e-6);
      EXPECT_NEAR(above.y(), std::round(above.y()), 1e-6);
    }
    EXPECT_NEAR((markers[markers.size() / 2] - Vector3(0.0, 0.0, 10e-3 - depth)).norm(), 0.0, 1e-9);
  }
}

/// A block has its whole face, and no other; its bond is no place for a marker's grid.
TEST(MarkerGrid, CoversAFlatFace) {
  using enum ProfileSurface;
  using enum ProfileCurve;
  const auto block = Geometry::of_profile({{8e-3, 0.0, free, straight},
                                           {8e-3, 5e-3, contact, straight},
                                           {0.0, 5e-3, axis, straight},
                                           {0.0, 0.0, bond, straight}});
  const auto markers = marker_grid(*shape_of(block), 3e-3, 2e-3);
  EXPECT_EQ(markers.size(), 21u);  // of 5 x 5 all but the corners
  for (const Vector3& marker : markers) EXPECT_NEAR(marker.z(), 3e-3, 1e-12);
}

TEST(MarkerGrid, IsRefusedWhereItCannotBe) {
  const auto key = [](double pitch, double depth) -> std::string {
    try {
      marker_grid(*shape_of(dome), pitch, depth);
    } catch (const InvalidInput& error) {
      return error.violations().front().key;
    }
    return "";
  };
  EXPECT_EQ(key(1e-3, 4.9e-3), "");
  EXPECT_EQ(key(1e-3, 5.1e-3), "sensor.marker_depth");  // in the rod
  EXPECT_EQ(key(0.1e-3, 0.0), "sensor.marker_pitch");
  EXPECT_EQ(key(0.2e-3, 0.0), "");
}

MarkerRow moved(int marker, const Vector3& displacement, double error) {
  return {.marker = marker,
          .place = Vector3(1e-3 * marker, 0.0, 8e-3),
          .displacement = displacement,
          .error = error};
}

TEST(MarkerDifferences, AreMeasuredOverAllMarkers) {
  const std::vector<MarkerRow> truth{moved(1, {0.0, 0.0, -3e-3}, 1e-5),
                                     moved(2, {4e-3, 0.0, 0.0}, 1e-5)},
      own{moved(1, {0.0, 0.0, -3.3e-3}, 2e-5), moved(2, {4e-3, 0.4e-3, 0.0}, unknown)};
  const MarkerLengths lengths = marker_lengths(truth);
  EXPECT_NEAR(lengths.rms, 5e-3 / std::sqrt(2.0), 1e-12);
  EXPECT_EQ(lengths.marker, 2);
  EXPECT_NEAR(lengths.largest, 4e-3, 1e-15);
  EXPECT_NEAR(lengths.error, 1e-5, 1e-15);
  EXPECT_TRUE(std::isnan(marker_lengths(own).error));

  const auto off = marker_differences(own, truth);
  ASSERT_EQ(off.size(), 2u);
  EXPECT_NEAR(off[0].error, 3e-5, 1e-15);
  EXPECT_NEAR(off[1].error, 1e-5, 1e-15) << "the one that is known";
  EXPECT_NEAR(marker_lengths(off).rms, 0.5e-3 / std::sqrt(2.0), 1e-12);
  EXPECT_EQ(marker_lengths(off).marker, 2);
}

/// As large a share of what moves as of the force; in the contact of all of the way; aside as the
/// lateral force.
TEST(MarkerErrors, GoWithThoseOfTheForces) {
  PressSample sample;
  sample.indentation = 1e-3;
  sample.normal_force = 2.0;
  sample.force_error = 0.02;
  sample.contact_radius = 3e-3;
  const Vector3 pole(0.0, 0.0, 10e-3);
  const auto errors = [&] {
    std::vector<MarkerRow> markers{
        {.place = pole},
        {.place = pole - Vector3(0.0, 0.0, 6e-3)},
        {.place = {0.0, 0.0, -2e-3}, .displacement = {0.0, 0.2e-3, 0.0}}};
    set_marker_errors(sample, pole, markers);
    return markers;
  };
  auto markers = errors();
  EXPECT_NEAR(markers[0].error, 1e-5, 1e-15);
  EXPECT_NEAR(markers[1].error, 0.25e-5, 1e-15);
  EXPECT_NEAR(markers[2].error, 0.2e-5, 1e-15);
  sample.lateral_displacement = 0.5e-3;
  sample.lateral_force_x = 0.4;
  sample.lateral_force_y = 0.0;
  sample.lateral_force_error = 0.02;  // 5 %
  markers = errors();
  EXPECT_NEAR(markers[0].error, 1e-5 + 2.5e-5, 1e-15);
  sample.force_error = unknown;
  EXPECT_TRUE(std::isnan(errors()[1].error));
}

TEST(MarkerDifferences, AreOfTheSameMarkersAlone) {
  const std::vector<MarkerRow> two{moved(1, Vector3::Zero(), 0.0), moved(2, Vector3::Zero(), 0.0)};
  std::vector<MarkerRow> other = two;
  other[1].place.x() += 1e-5;
  EXPECT_TRUE(marker_differences(two, other).empty());
  EXPECT_TRUE(marker_differences(two, std::vector{two.front()}).empty());
  EXPECT_TRUE(std::isnan(marker_lengths({}).rms));
}

}  // namespace
