#include "studies/report/figure/contours.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using namespace fingertip::studies::report;

template <class Function>
GridFunction sampled(int n, const Function& function) {
  GridFunction grid;
  for (int i = 0; i < n; ++i) {
    // Not equidistant along y.
    grid.x.push_back(-2.0 + 4.0 * i / (n - 1));
    grid.y.push_back(-2.0 + 4.0 * std::pow(double(i) / (n - 1), 1.2));
  }
  for (const double x : grid.x) {
    grid.values.emplace_back();
    for (const double y : grid.y) grid.values.back().push_back(function(x, y));
  }
  return grid;
}

TEST(Contours, RefinementIsExactForCubics) {
  const auto cubic = [](double x, double y) {
    return 1.0 + x * y * y - 2.0 * x * x * x * y + y * y * y;
  };
  const GridFunction fine = refined(sampled(6, cubic), 5);
  ASSERT_EQ(fine.x.size(), 26u);
  ASSERT_TRUE(fine.valid());
  for (std::size_t i = 0; i < fine.x.size(); ++i)
    for (std::size_t j = 0; j < fine.y.size(); ++j)
      EXPECT_NEAR(fine.values[i][j], cubic(fine.x[i], fine.y[j]), 1e-12);
}

TEST(Contours, LevelOfAQuadraticFormIsItsEllipse) {
  const auto form = [](double x, double y) { return 3.0 * x * x - 2.0 * x * y + 2.0 * y * y; };
  const auto lines = level_lines(refined(sampled(9, form), 16), 2.0);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].front(), lines[0].back()) << "closed";
  double area = 0.0;
  for (std::size_t i = 0; i + 1 < lines[0].size(); ++i) {
    const auto [x, y] = lines[0][i];
    EXPECT_NEAR(form(x, y), 2.0, 5e-3);
    area += 0.5 * (x * lines[0][i + 1].second - y * lines[0][i + 1].first);
  }
  // Of xᵀ A x = c it is pi c / sqrt(det A).
  EXPECT_NEAR(std::abs(area), std::acos(-1.0) * 2.0 / std::sqrt(5.0), 2e-3);
}

TEST(Contours, LinesThatLeaveTheGridAreOpenAndSaddlesStaySeparate) {
  const auto saddle = [](double x, double y) { return (x + 0.013) * (y - 0.021); };
  for (const double level : {0.4, -0.4}) {
    const auto lines = level_lines(refined(sampled(7, saddle), 4), level);
    ASSERT_EQ(lines.size(), 2u) << "the two branches of a hyperbola";
    for (const Polyline& line : lines)
      for (const auto& [x, y] : line) EXPECT_NEAR(saddle(x, y), level, 0.01);
  }
}

TEST(Contours, UnknownValuesInterruptLinesAndSpoilNothingElse) {
  const auto form = [](double x, double y) { return x * x + y * y; };
  GridFunction grid = sampled(9, form);
  grid.values[7][7] = std::numeric_limits<double>::quiet_NaN();
  const GridFunction fine = refined(grid, 4);
  for (const Polyline& line : level_lines(fine, 1.0))
    for (const auto& [x, y] : line) EXPECT_NEAR(form(x, y), 1.0, 0.01);
  grid.values[4][4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NEAR(refined(grid, 2).values[2][2], form(grid.x[1], grid.y[1]), 1e-12);
}

TEST(Contours, KnowsWhatIsNoGrid) {
  EXPECT_FALSE(GridFunction().valid());
  EXPECT_FALSE((GridFunction{{0, 1}, {0, 1}, {{1, 2}}}).valid());
  EXPECT_FALSE((GridFunction{{0, 1}, {0, 1}, {{1, 2}, {1}}}).valid());
  EXPECT_FALSE((GridFunction{{0, 0}, {0, 1}, {{1, 2}, {1, 2}}}).valid());
  EXPECT_TRUE((GridFunction{{0, 1}, {0, 1}, {{1, 2}, {1, 2}}}).valid());
}

}  // namespace
