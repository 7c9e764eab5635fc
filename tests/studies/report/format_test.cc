#include "studies/report/format.h"

#include <gtest/gtest.h>

#include <cmath>

#include "studies/files/shown_units.h"

namespace {

using fingertip::studies::shown_units;
using fingertip::studies::reporting::number_with_error;

TEST(Format, AForceEndsWhereItsErrorBegins) {
  EXPECT_EQ(number_with_error(197.181, 0.59), "197.2");
  EXPECT_EQ(number_with_error(197.181, 0.59, 6), "197.18");
  EXPECT_EQ(number_with_error(19.4231, 1.3), "19.4");
  EXPECT_EQ(number_with_error(0.0123456, 0.0021), "0.0123");
  EXPECT_EQ(number_with_error(-19.4231, 1.3), "−19.4");
}

TEST(Format, AForceBelowItsErrorIsZeroWithoutSign) {
  EXPECT_EQ(number_with_error(-1e-12, 0.01), "0");
  EXPECT_EQ(number_with_error(-0.0, 0.01), "0");
  EXPECT_EQ(number_with_error(-0.0, 0.0), "0");
  EXPECT_EQ(shown_units().force.decimals(-1e-12), "0.0000");
  EXPECT_EQ(shown_units().force.decimals(-1.0 / shown_units().force.factor), "-1.0000");
}

TEST(Format, WithoutAnErrorAllDigitsStay) {
  EXPECT_EQ(number_with_error(19.4231, std::nan("")), "19.42");
  EXPECT_EQ(number_with_error(19.4231, 0.0), "19.42");
  EXPECT_EQ(number_with_error(std::nan(""), 0.1), "–");
}

}  // namespace
