#include <gtest/gtest.h>

#include "fem_reference/verification/verification.h"
#include "tests/temporary_folder.h"

using namespace fingertip::fem_reference;

namespace {

void expect_passed(const std::vector<Check>& checks) {
  for (const Check& check : checks)
    EXPECT_TRUE(check.passed) << check.name << ", " << check.quantity << ": " << check.value
                              << ", expected " << check.expected;
}

/// A rod of a tenth of the radius gives way: far from Hertz at any depth, but on its way there.
TEST(HertzLimit, IsReachedByExtrapolationOnASlenderRod) {
  const TemporaryFolder folder;
  const HertzResult result = press_towards_hertz(0.1, {1e-6, 2e-6, 4e-6, 8e-6}, 3, folder.path());
  expect_passed(check_hertz(result));
  EXPECT_LT(result.slope, -3.0);
  for (std::size_t i = 1; i < result.excess.size(); ++i)
    EXPECT_LT(result.excess[i], result.excess[i - 1]);
}

/// A rod of 0.3 R gives way as much as the thin rubber above it resists: Hertz within 1 %.
TEST(HertzLimit, IsMetOnARodOfThreeTenths) {
  const TemporaryFolder folder;
  const HertzResult result = press_towards_hertz(0.3, {1e-6, 2e-6, 4e-6, 8e-6}, 3, folder.path());
  expect_passed(check_hertz(result));
  for (const double excess : result.excess) EXPECT_NEAR(excess, 0.0, 0.01);
}

}  // namespace
