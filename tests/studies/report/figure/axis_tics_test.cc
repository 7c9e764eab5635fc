#include "studies/report/figure/axis_tics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace fingertip::studies::report;

namespace {

/// How many tics a reader sees on an axis with this extent of data, padded by 10 %.
std::ptrdiff_t seen(double from, double to) {
  const Range shown{from / 1.1, 1.1 * to};
  return std::ranges::count_if(logarithmic_tics({from, to}, shown),
                               [&](double tic) { return shown.from <= tic && tic <= shown.to; });
}

TEST(AxisTics, ThreeToTenAreSeenWhateverAnAxisSpans) {
  for (const double span : {1.0001, 1.05, 1.3, 2.0, 2.5, 4.0, 8.0, 30.0, 1e3, 1e6})
    for (double from = 1e-5; from < 1e5; from *= 1.37) {
      EXPECT_GE(seen(from, span * from), 3) << from << " to " << span * from;
      EXPECT_LE(seen(from, span * from), 10) << from << " to " << span * from;
    }
}

TEST(AxisTics, AreRoundNumbers) {
  // Unknowns of the meshes of a press.
  EXPECT_EQ(logarithmic_tics({1040.0, 2550.0}, {1000.0, 2800.0}),
            (std::vector{1000.0, 1500.0, 2000.0, 2500.0}));
  EXPECT_EQ(logarithmic_tics({30.0, 400.0}, {25.0, 450.0}),
            (std::vector{10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0}));
  EXPECT_EQ(logarithmic_tics({1.0, 1000.0}, {0.9, 1100.0}),
            (std::vector{1.0, 10.0, 100.0, 1000.0}));
}

TEST(AxisTics, HaveLabelsOfFewDigits) {
  EXPECT_EQ(tic_label(200.0), "200");
  EXPECT_EQ(tic_label(0.05), "0.05");
  EXPECT_EQ(tic_label(1e5), "10⁵");
  EXPECT_EQ(tic_label(12500.0), "1.25×10⁴");
}

}  // namespace
