#include "fem_reference/press/known_way.h"

#include <gtest/gtest.h>

using namespace fingertip;
using fem_reference::KnownWay;
using fem_reference::Vector;

namespace {

Vector of(double value) {
  Vector result(dealii::complete_index_set(2), MPI_COMM_SELF);
  result = value;
  return result;
}

/// Known of another mesh: 2 at 0.25, 4 at 1.
KnownWay way() {
  return KnownWay(1, {{0.0, of(0.0)}, {0.25, of(2.0)}, {1.0, of(4.0)}}, 0.0, of(0.0));
}

TEST(KnownWay, IsLinearBetweenPoints) {
  EXPECT_FALSE(KnownWay().reaches(0.0));
  EXPECT_TRUE(way().reaches(1.0));
  EXPECT_FALSE(way().reaches(1.1));
  EXPECT_DOUBLE_EQ(way().known(0.125)[0], 1.0);
  EXPECT_DOUBLE_EQ(way().known(0.25)[0], 2.0);
  EXPECT_DOUBLE_EQ(way().known(0.625)[0], 3.0);
  EXPECT_EQ(way().until(1.0), std::vector<double>{0.25});
  EXPECT_EQ(way().until(0.25), std::vector<double>());
}

/// What was passed is corrected in proportion, what is to come is not.
TEST(KnownWay, IsCorrectedWhereThePressHasBeen) {
  KnownWay corrected = way();
  corrected.pass(0.5, of(3.0));  // 8/3 were known
  EXPECT_NEAR(corrected.difference()[0], 1.0 / 3.0, 1e-15);
  EXPECT_NEAR(corrected.points().at(0.25)[0], 2.0 + 0.5 / 3.0, 1e-15);
  EXPECT_EQ(corrected.points().at(0.5)[0], 3.0);
  EXPECT_NEAR(corrected.known(0.75)[0], way().known(0.75)[0], 1e-15);
  EXPECT_EQ(corrected.until(1.0), std::vector<double>());
  corrected.pass(1.0, of(5.0));
  EXPECT_NEAR(corrected.difference()[0], 1.0, 1e-15);
  corrected.pass(2.0, of(7.0));  // beyond what was known
  EXPECT_EQ(corrected.difference()[0], 0.0);
  EXPECT_EQ(corrected.points().at(2.0)[0], 7.0);
  EXPECT_TRUE(corrected.reaches(2.0));
}

}  // namespace
