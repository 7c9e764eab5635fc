#include "studies/config/text/units.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include <cmath>

using fingertip::studies::convert;
using fingertip::studies::parse_quantity;
using fingertip::studies::UnitError;

namespace {

double pressure(const std::string& text) {
  return parse_quantity(text, "Pa", "40 gf/cm^2");
}

std::string rule_broken_by(const std::string& text, const std::string& unit) {
  try {
    parse_quantity(text, unit, "1 " + unit);
  } catch (const UnitError& error) {
    return error.rule;
  }
  return "";
}

}  // namespace

TEST(Units, GramForceIsTheWeightOfAGram) {
  // 1 gf/cm² = 1e-3 kg * 9.80665 m/s² / 1e-4 m² = 98.0665 Pa.
  EXPECT_DOUBLE_EQ(pressure("40 gf/cm^2"), 3922.66);
  EXPECT_DOUBLE_EQ(pressure("14 gf/cm^2"), 1372.931);
  EXPECT_DOUBLE_EQ(parse_quantity("1 gf", "N", "1 N"), 9.80665e-3);
}

TEST(Units, SameQuantityInTwoUnitsIsTheSameNumber) {
  EXPECT_EQ(pressure("40 gf/cm^2"), pressure("3.92266 kPa"));
  EXPECT_EQ(pressure("3922.66 N/m^2"), pressure("40 gf/cm^2"));
  EXPECT_EQ(parse_quantity("0.5 g/cm^3", "kg/m^3", "1"), 500.0);
  EXPECT_EQ(parse_quantity("0.3 ms", "s", "1"), 3e-4);
  EXPECT_EQ(parse_quantity("1 cm/s", "m/s", "1"), parse_quantity("10 mm/s", "m/s", "1"));
  EXPECT_EQ(parse_quantity("0.1 kHz", "Hz", "1"), 100.0);
}

TEST(Units, AcceptsSpacesSignsAndExponents) {
  EXPECT_EQ(parse_quantity("  +1e1mm ", "m", "1 m"), 0.01);
  EXPECT_EQ(parse_quantity("-2.5 cm", "m", "1 m"), -0.025);
}

TEST(Units, RefusesWhatIsNoQuantityOfTheDimension) {
  EXPECT_NE(rule_broken_by("40 cm", "Pa").find("wrong dimension"), std::string::npos);
  EXPECT_NE(rule_broken_by("40", "Pa").find("unit is missing"), std::string::npos);
  EXPECT_NE(rule_broken_by("nan Pa", "Pa").find("finite"), std::string::npos);
  EXPECT_NE(rule_broken_by("inf Pa", "Pa").find("finite"), std::string::npos);
  EXPECT_NE(rule_broken_by("1e999 Pa", "Pa"), "");
  EXPECT_NE(rule_broken_by("1e300 Mm", "Pa"), "");
  EXPECT_NE(rule_broken_by("Pa", "Pa"), "");
  EXPECT_NE(rule_broken_by("", "Pa"), "");
  EXPECT_NE(rule_broken_by("1 2 Pa", "Pa").find("not a unit"), std::string::npos);
  EXPECT_NE(rule_broken_by("1 blub", "Pa").find("not a unit"), std::string::npos);
}

TEST(Units, RefusesWhatOnlyLooksConvertible) {
  EXPECT_NE(rule_broken_by("10 s", "Hz"), "");       // the reciprocal
  EXPECT_NE(rule_broken_by("377 rad/s", "Hz"), "");  // would be wrong by 2 pi
  EXPECT_NE(rule_broken_by("20 degC", "K"), "");     // has an offset
}

TEST(Units, AnglesAreNoPlainNumbers) {
  const double right_angle = 2.0 * std::atan(1.0);
  EXPECT_NEAR(parse_quantity("90 deg", "rad", "1 deg"), right_angle, 1e-14);
  EXPECT_NEAR(parse_quantity("-5400 arcmin", "rad", "1 deg"), -right_angle, 1e-14);
  EXPECT_EQ(parse_quantity("0.1 rad", "rad", "1 deg"), 0.1);
  EXPECT_EQ(parse_quantity("0 deg", "rad", "1 deg"), 0.0);
  for (const char* text : {"5 %", "0.1 m/m", "1 rad^2", "0.1", "1 Hz", "1 s"}) {
    EXPECT_NE(rule_broken_by(text, "rad"), "") << text;
  }
  EXPECT_NE(rule_broken_by("20 deg/s", "Hz"), "");
}

TEST(Units, ConvertsBack) {
  EXPECT_NEAR(convert(98.0665, "Pa", "gf/cm^2"), 1.0, 1e-14);
  EXPECT_THROW(convert(1.0, "Pa", "m"), UnitError);
}

// The presses of a sweep read their settings side by side.
TEST(Units, MayBeReadFromManyThreads) {
  std::atomic<int> wrong = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&wrong] {
      for (int i = 0; i < 500; ++i) {
        if (std::abs(parse_quantity("40 gf/cm^2", "Pa", "1 Pa") - 3922.66) > 1e-9) ++wrong;
        if (std::abs(parse_quantity("2.5 mm", "m", "1 m") - 2.5e-3) > 1e-15) ++wrong;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}
