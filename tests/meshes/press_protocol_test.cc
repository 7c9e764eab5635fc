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

}  // namespace
}  // namespace fingertip::meshes
