#include "meshes/press/press_protocol.h"

#include <gtest/gtest.h>

#include <cmath>

#include "meshes/press/no_equilibrium.h"
#include "meshes/press/press_motion.h"

using namespace fingertip::meshes;

namespace {

/// Stages at 3 mm.
PressStage lateral_to(double displacement) {
  return {.indentation = 3e-3, .speed = 1e-3, .move = StageMove::lateral, .lateral = displacement};
}
PressStage twist_to(double angle, double speed = 1.0) {
  return {.indentation = 3e-3, .speed = speed, .move = StageMove::twist, .twist = angle};
}

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

TEST(PressProtocol, ALateralMotionHasOutputs) {
  PressProtocol protocol;
  protocol.lateral_samples = 0;
  const auto found = protocol.violations(Geometry{});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].key, "press.lateral_samples");
}

TEST(PressPath, ADiagonalIsOneStraightLine) {
  PressProtocol protocol;
  protocol.depth = 2e-3;
  protocol.lateral = -1e-3;
  const PressPath path(protocol);
  EXPECT_EQ(path.length(), 2e-3);
  EXPECT_EQ(path.samples(), default_samples(2e-3));
  EXPECT_EQ(path.slope(), -0.5);
  for (const double s : {-1e-4, 3e-4, 2e-3}) {
    EXPECT_EQ(path.at(s).indentation, s);
    EXPECT_EQ(path.at(s).lateral, -0.5 * s);
  }
  EXPECT_FALSE(path.bends(0.0, 1.0));
}

TEST(PressPath, AfterGoesDownAndThenAside) {
  for (const double lateral : {7e-4, -7e-4}) {
    PressProtocol protocol;
    protocol.depth = 2e-3;
    protocol.samples = {1e-3, 2e-3};
    protocol.lateral = lateral;
    protocol.lateral_path = LateralPath::after;
    protocol.lateral_samples = 7;
    EXPECT_TRUE(protocol.moves_after());
    const PressPath path(protocol);
    EXPECT_NEAR(path.length(), 2.7e-3, 1e-18);
    ASSERT_EQ(path.samples().size(), 9u);
    EXPECT_EQ(path.samples().back(), path.length());
    for (const double s : {-1e-4, 1e-3, 2e-3}) {
      EXPECT_EQ(path.at(s).indentation, s);
      EXPECT_EQ(path.at(s).lateral, 0.0);
    }
    for (int i = 1; i <= 7; ++i) {
      const PressPose pose = path.at(path.samples()[std::size_t(i) + 1]);
      EXPECT_EQ(pose.indentation, 2e-3);
      EXPECT_EQ(pose.lateral, lateral * i / 7) << "a sample is where it was asked for";
    }
    EXPECT_NEAR(path.at(2.05e-3).lateral, std::copysign(5e-5, lateral), 1e-18);
    EXPECT_TRUE(path.bends(1.9e-3, 2.1e-3));
    EXPECT_FALSE(path.bends(1.9e-3, 2e-3));
    EXPECT_FALSE(path.bends(2e-3, 2.1e-3));
  }
}

/// Depth times angle is its way.
TEST(PressPath, TwistsAtFullDepthTogetherWithALateralMotion) {
  PressProtocol protocol;
  protocol.depth = 2e-3;
  protocol.samples = {2e-3};
  protocol.lateral = 1e-3;
  protocol.twist = -0.5;
  protocol.lateral_samples = 4;
  const PressPath beside(protocol);  // aside on the way down, then the twist
  EXPECT_NEAR(beside.length(), 2e-3 + 0.5 * 2e-3, 1e-18);
  EXPECT_EQ(beside.at(2e-3).lateral, 1e-3);
  EXPECT_EQ(beside.at(1e-3).twist, 0.0);
  protocol.lateral_path = LateralPath::after;
  const PressPath path(protocol);
  ASSERT_EQ(path.samples().size(), 5U);
  EXPECT_NEAR(path.length(), 2e-3 + 1e-3 + 0.5 * 2e-3, 1e-18);
  for (int i = 1; i <= 4; ++i) {
    const PressPose pose = path.at(path.samples()[std::size_t(i)]);
    EXPECT_EQ(pose.indentation, 2e-3);
    EXPECT_NEAR(pose.lateral, 1e-3 * i / 4, 1e-18);
    EXPECT_NEAR(pose.twist, -0.5 * i / 4, 1e-16);
  }
  EXPECT_NEAR(path.at(3e-3).twist, -0.25, 1e-15);
}

TEST(PressPath, AProgramGoesAsideAndTwistsThereAndBack) {
  PressProtocol protocol;
  protocol.depth = 3e-3;
  protocol.samples = {3e-3};
  protocol.lateral_samples = 2;
  PressStage up = twist_to(0.1);
  up = {.indentation = 1e-3, .speed = 0.01, .lateral = 1e-3, .twist = 0.1};
  PressStage both = twist_to(0.1), back = twist_to(0.0);
  both.lateral = back.lateral = 1e-3;
  protocol.program = {{3e-3, 0.01, 0.0}, lateral_to(1e-3), both, back, both, up};
  EXPECT_TRUE(protocol.violations(Geometry{}).empty());
  const PressPath path(protocol);
  std::vector<double> lateral, twist;
  for (const double place : path.samples()) {
    lateral.push_back(1e3 * path.at(place).lateral);
    twist.push_back(path.at(place).twist);
  }
  EXPECT_EQ(lateral, (std::vector<double>{0, 0.5, 1, 1, 1, 1, 1, 1, 1, 1}));
  EXPECT_EQ(twist, (std::vector<double>{0, 0, 0, 0.05, 0.1, 0.05, 0, 0.05, 0.1, 0.1}));
  EXPECT_EQ(path.at(path.length()).indentation, 1e-3);
  EXPECT_NEAR(path.length(), 3e-3 + 1e-3 + 3 * 0.1 * 3e-3 + 2e-3, 1e-17);
  EXPECT_EQ(path.stage(9), 6.0);
  const fingertip::meshes::PressMotion motion(protocol);
  EXPECT_NEAR(motion.stages()[1].end - motion.stages()[1].begin, 1.0, 1e-12) << "1 mm at 1 mm/s";
  EXPECT_EQ(motion.stages()[1].to, 3e-3);
}

TEST(PressPath, AfterWithoutLateralMotionIsAStraightPress) {
  PressProtocol protocol;
  protocol.lateral_path = LateralPath::after;
  EXPECT_FALSE(protocol.moves_after());
  EXPECT_EQ(PressPath(protocol).samples(), default_samples(protocol.depth));
  EXPECT_EQ(PressPath(protocol).length(), protocol.depth);
}

TEST(PressPath, AProgramGoesUpAndDownAndHoldsAddNothing) {
  PressProtocol protocol;
  protocol.depth = 2e-3;
  protocol.samples = {0.5e-3, 2e-3};
  protocol.lateral = 1e-3;
  protocol.program = {{2e-3, 0.01, 0.0}, {2e-3, 0.0, 1.0}, {-0.1e-3, 0.02, 0.0}, {1e-3, 0.01, 0.0}};
  EXPECT_TRUE(protocol.violations(Geometry{}).empty());
  const PressPath path(protocol);
  EXPECT_NEAR(path.length(), 2e-3 + 2.1e-3 + 1.1e-3, 1e-18);
  std::vector<double> depths;
  double before = 0.0;
  for (const double place : path.samples()) {
    EXPECT_GT(place, before);
    depths.push_back(path.at(place).indentation);
    EXPECT_EQ(path.at(place).lateral, 0.5 * depths.back());
    before = place;
  }
  EXPECT_EQ(depths, (std::vector<double>{0.5e-3, 2e-3, 0.5e-3, -0.1e-3, 0.5e-3, 1e-3}));
  EXPECT_EQ(path.samples().back(), path.length());
  EXPECT_EQ(path.stage(1), 1.0);
  EXPECT_EQ(path.stage(2), 3.0);
  EXPECT_EQ(path.stage(5), 4.0);
  EXPECT_TRUE(std::isnan(PressPath(PressProtocol{}).stage(0)));
  EXPECT_EQ(path.at(-1e-4).indentation, -1e-4);
  EXPECT_EQ(path.at(1e-3).indentation, 1e-3);
  EXPECT_NEAR(path.at(2.3e-3).indentation, 1.7e-3, 1e-18);
  EXPECT_NEAR(path.at(4.6e-3).indentation, 0.4e-3, 1e-18);
  EXPECT_TRUE(path.bends(1.9e-3, 2.1e-3));
  EXPECT_TRUE(path.bends(4e-3, 4.2e-3));
  EXPECT_FALSE(path.bends(2.1e-3, 4e-3));
}

TEST(PressProtocol, RefusesProgramsByTheNumberOfTheirStage) {
  const Geometry geometry;
  const auto rule_of = [&](std::vector<PressStage> program) {
    PressProtocol protocol;
    protocol.program = std::move(program);
    const auto found = protocol.violations(geometry);
    if (found.empty()) return std::string();
    EXPECT_EQ(found[0].key, "press.program");
    return found[0].rule;
  };
  const PressStage down{3e-3, 0.01, 0.0}, hold{3e-3, 0.0, 1.0};
  EXPECT_EQ(rule_of({down, hold, {0.0, 0.1, 0.0}, {-0.5e-3, 0.1, 0.0}, down}), "");
  const auto begins = [&](std::vector<PressStage> program, const std::string& words) {
    const std::string rule = rule_of(std::move(program));
    EXPECT_TRUE(rule.starts_with(words)) << rule;
  };
  begins({hold}, "stage 1: a program begins with a move");
  begins({{0.0, 0.01, 0.0}}, "stage 1: the first stage must press");
  begins({down, {-0.6e-3, 0.01, 0.0}}, "stage 2: the indentation must lie");
  begins({down, {geometry.thickness(), 0.01, 0.0}}, "stage 2: the indentation must lie");
  begins({down, {std::nan(""), 0.01, 0.0}}, "stage 2: the indentation must lie");
  begins({down, {1e-3, -0.01, 0.0}}, "stage 2: the speed");
  begins({down, {3e-3, 0.01, 0.0}}, "stage 2: the move ends where it begins");
  begins({down, {3e-3, 0.0, 0.0}}, "stage 2: a hold must take");
  begins({down, {3e-3, 0.0, HUGE_VAL}}, "stage 2: a hold must take");
  begins({down, {2e-3, 0.0, 1.0}}, "stage 2: a hold stays");
  begins({twist_to(0.1)}, "stage 1: the first stage must press");
  begins({down, twist_to(2.0)}, "stage 2: a twist lies between");
  begins({down, lateral_to(0.02)}, "stage 2: the lateral motion must not exceed");
  begins({down, twist_to(0.1), twist_to(0.1)}, "stage 3: the move ends where");
  begins({down, twist_to(0.1, -1.0)}, "stage 2: the speed");
  begins({down, lateral_to(1e-3), lateral_to(0.0), twist_to(0.1)}, "");
  begins({down, {2e-3, 0.01, 1.0}}, "stage 2: a stage moves or holds");
  begins({{2e-3, 0.01, 0.0}}, "press.depth must be the program's largest");
  begins({{3e-3, 0.02, 0.0}}, "press.speed must be the speed of the first stage");
}

TEST(PressProtocol, NamesTellTheModesApart) {
  EXPECT_EQ(name(ContactMode::stick), "stick");
  EXPECT_EQ(name(ContactMode::frictionless), "frictionless");
  EXPECT_EQ(name(ContactMode::coulomb), "coulomb");
  EXPECT_EQ(name(LateralPath::diagonal), "diagonal");
  EXPECT_EQ(name(LateralPath::after), "after");
}

TEST(PressProtocol, KnowsWhatAMotionAlongThePlaneBreaks) {
  PressProtocol protocol;
  EXPECT_TRUE(protocol.is_straight() && protocol.mirrored(0) && protocol.mirrored(1));
  protocol.lateral = -1e-3;
  EXPECT_FALSE(protocol.mirrored(0));
  EXPECT_TRUE(protocol.mirrored(1));
  EXPECT_EQ(protocol.lateral_range(), std::pair(-1e-3, 0.0));
  protocol.twist = 0.1;
  EXPECT_FALSE(protocol.mirrored(1));
  protocol = {};
  protocol.program = {{3e-3, 0.01, 0.0}, lateral_to(1e-3), lateral_to(-2e-3)};
  EXPECT_EQ(protocol.lateral_range(), std::pair(-2e-3, 1e-3));
  EXPECT_TRUE(protocol.mirrored(1));
  EXPECT_TRUE(protocol.goes_back());
  protocol.program = {{3e-3, 0.01, 0.0}, twist_to(-0.1)};
  EXPECT_FALSE(protocol.mirrored(1));
  EXPECT_FALSE(protocol.goes_back());
  protocol.twist = 0.2;
  EXPECT_TRUE(protocol.violations(Geometry{}).front().rule.starts_with("no lateral motion and no"));
  protocol = {};
  protocol.twist = 1.6;
  EXPECT_EQ(protocol.violations(Geometry{}).front().key, "press.twist");
}

/// Depth and remedies as a user can copy them.
TEST(NoEquilibrium, TellsHowDeepAndWhatHelps) {
  const fingertip::meshes::NoEquilibrium straight("the press", {0.0096499999}, "it buckles",
                                                  "refine");
  EXPECT_STREQ(straight.what(),
               "the press found no equilibrium beyond an indentation of 0.00965 m (it buckles); "
               "press less deep, press.depth = \"9.64 mm\", or refine");
  EXPECT_EQ(straight.indentation(), 0.0096499999);
  const fingertip::meshes::NoEquilibrium aside("the press", {0.0, 1e-3, 0.0}, "", "refine");
  EXPECT_STREQ(aside.what(),
               "the press found no equilibrium beyond an indentation of 0 m and a lateral "
               "displacement of 0.001 m; press less deep, move less far, or refine");
  const fingertip::meshes::NoEquilibrium turned("the press", {0.0, 0.0, 0.1}, "", "refine");
  EXPECT_STREQ(
      turned.what(),
      "the press found no equilibrium beyond an indentation of 0 m and a twist of 0.1 rad; "
      "press less deep, twist less, or refine");
}

}  // namespace
