#include "meshes/tables/interpolation.h"

#include <gtest/gtest.h>

#include <array>
#include <span>

using fingertip::meshes::interpolated;

TEST(Interpolation, IsAStraightLineBetweenPointsAndConstantBeyond) {
  constexpr std::array xs{1.0, 2.0, 6.0}, ys{5.0, -3.0, 1.0};
  for (std::size_t i = 0; i < xs.size(); ++i) EXPECT_EQ(interpolated(xs, ys, xs[i]), ys[i]) << i;
  EXPECT_DOUBLE_EQ(interpolated(xs, ys, 1.25), 3.0);
  EXPECT_DOUBLE_EQ(interpolated(xs, ys, 5.0), 0.0);
  EXPECT_EQ(interpolated(xs, ys, 0.0), 5.0);
  EXPECT_EQ(interpolated(xs, ys, 7.0), 1.0);
}

TEST(Interpolation, OfOnePointIsThatPoint) {
  constexpr std::array x{2.0, 3.0}, y{4.0, 5.0};
  for (const double at : {1.0, 2.0, 3.0})
    EXPECT_EQ(interpolated(std::span(x).first(1), std::span(y).first(1), at), 4.0) << at;
}
