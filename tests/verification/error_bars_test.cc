#include "tests/verification/error_bars.h"

using namespace error_bars;

/// Another tip than the default one, nearly incompressible rubber.
TEST(ErrorBars, ReachTheTruth) {
  const Tally tally = compare({tips[1],
                               0.47,
                               ContactMode::frictionless,
                               Strain::linear,
                               {0.06, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6}},
                              5e-3);
  EXPECT_EQ(tally.covered, tally.values);
}
