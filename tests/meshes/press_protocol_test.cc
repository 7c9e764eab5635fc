#include "meshes/press_protocol.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fingertip::meshes {
namespace {

TEST(PressProtocol, DefaultIsValidWithItsDefaultSamples) {
  PressProtocol protocol;
  protocol.samples = default_samples(protocol.depth);
  EXPECT_TRUE(protocol.violations(Geometry{}).empty());
  EXPECT_EQ(protocol.samples.size(), 10u);
  EXPECT_EQ(protocol.samples.back(), protocol.depth);
  EXPECT_NEAR(protocol.samples[3], 0.5e-3, 1e-18);
}

TEST(PressProtocol, RefusesDepthsOutsideTheRubber) {
  const Geometry geometry;
  for (const double depth : {0.0, -1e-3, geometry.thickness(), 1.0, std::nan("")}) {
    PressProtocol protocol;
    protocol.depth = depth;
    const auto found = protocol.violations(geometry);
    ASSERT_EQ(found.size(), 1u) << depth;
    EXPECT_EQ(found[0].key, "press.depth");
  }
}

TEST(PressProtocol, RefusesSamplesThatDoNotIncreaseOrDoNotEndAtTheDepth) {
  PressProtocol protocol;
  protocol.samples = {1e-3, 1e-3, 3e-3};
  EXPECT_EQ(protocol.violations(Geometry{}).size(), 1u);
  protocol.samples = {1e-3, 2e-3};
  EXPECT_EQ(protocol.violations(Geometry{}).size(), 1u);
  protocol.samples = {-1e-3, 3e-3};
  EXPECT_EQ(protocol.violations(Geometry{}).size(), 1u);
}

TEST(PressProtocol, FrictionMustBePositiveWhereItCounts) {
  for (const double friction : {0.0, -0.5, std::nan(""), HUGE_VAL}) {
    PressProtocol protocol;
    protocol.friction = friction;
    EXPECT_TRUE(protocol.violations(Geometry{}).empty()) << "stick has no coefficient";
    protocol.contact = ContactMode::coulomb;
    const auto found = protocol.violations(Geometry{});
    ASSERT_EQ(found.size(), 1u) << friction;
    EXPECT_EQ(found[0].key, "press.friction");
  }
}

TEST(PressProtocol, TiltStaysWithin45DegreesAndLateralWithinTheTip) {
  const double right_angle = 2.0 * std::atan(1.0);
  const Geometry geometry;
  const auto key_of = [&](double tilt, double lateral) {
    PressProtocol protocol;
    protocol.tilt = tilt;
    protocol.lateral = lateral;
    const auto found = protocol.violations(geometry);
    return found.empty() ? std::string() : found[0].key;
  };
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_EQ(key_of(sign * 0.5 * right_angle, 0.0), "");
    EXPECT_EQ(key_of(sign * 0.51 * right_angle, 0.0), "press.tilt");
    EXPECT_EQ(key_of(0.0, sign * geometry.tip_radius), "");
    EXPECT_EQ(key_of(0.0, sign * 1.01 * geometry.tip_radius), "press.lateral");
  }
  EXPECT_EQ(key_of(std::nan(""), 0.0), "press.tilt");
  EXPECT_EQ(key_of(0.0, std::nan("")), "press.lateral");
}

TEST(PressProtocol, NamesTellTheModesApart) {
  EXPECT_EQ(name(ContactMode::stick), "stick");
  EXPECT_EQ(name(ContactMode::frictionless), "frictionless");
  EXPECT_EQ(name(ContactMode::coulomb), "coulomb");
}

}  // namespace
}  // namespace fingertip::meshes
