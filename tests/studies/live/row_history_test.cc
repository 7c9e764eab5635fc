#include "studies/live/row_history.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace fingertip::studies;

namespace {

/// Pressed by 3 mm within 0.3 s, then at rest but for a thousandth of a micrometre.
LiveRow row_at(int millisecond) {
  const double time = 1e-3 * millisecond, depth = 3e-3 * std::min(1.0, time / 0.3);
  LiveRow row;
  row.time = time;
  row.indentation = depth + 1e-9 * std::sin(time);
  row.normal_force = 100.0 * std::pow(depth, 1.5);
  return row;
}

/// How far apart neighbours of the press are, over its depth.
double widest_gap(const std::vector<LiveRow>& rows) {
  double widest = 0.0, before = 0.0;
  for (const LiveRow& row : rows) {
    widest = std::max(widest, row.indentation - before);
    before = std::max(before, row.indentation);
  }
  return widest / 3e-3;
}

/// What a page gets that is opened after ten minutes.
TEST(RowHistory, KeepsThePressHoweverLongTheFingerRests) {
  RowHistory history;
  history.restart(row_at(0));
  constexpr int minutes = 10, periods = 60000 * minutes;
  for (int i = 1; i <= periods; ++i) history.add(row_at(i));
  const LiveRows rows = history.from(0, 600);
  EXPECT_LE(rows.rows.size(), 600u);
  EXPECT_EQ(rows.next, std::uint64_t(periods) + 1);
  EXPECT_LT(rows.rows.front().indentation, 0.1e-3);
  EXPECT_LT(widest_gap(rows.rows), 0.05);
  EXPECT_EQ(rows.rows.back().time, row_at(periods).time);
  EXPECT_TRUE(std::ranges::is_sorted(rows.rows, {}, &LiveRow::time));
}

TEST(RowHistory, GivesEachRowOnce) {
  RowHistory history;
  history.restart(row_at(0));
  for (int i = 1; i < 100; ++i) history.add(row_at(i));
  const LiveRows first = history.from(0, 600);
  ASSERT_EQ(first.rows.size(), 100u);
  for (int i = 100; i < 130; ++i) history.add(row_at(i));
  const LiveRows then = history.from(first.next, 600);
  ASSERT_EQ(then.rows.size(), 30u);
  EXPECT_EQ(then.rows.front().time, row_at(100).time);
  EXPECT_TRUE(history.from(then.next, 600).rows.empty());
  history.restart(row_at(0));
  EXPECT_EQ(history.from(0, 600).rows.size(), 1u);
}

}  // namespace
