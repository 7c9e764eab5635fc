#include "tests/verification/error_bars.h"

using namespace error_bars;

TEST(ErrorBars, ReachTheTruthInNineteenOfTwentyCases) {
  Tally all;
  const auto add = [&all](const Press& press, double tolerance) {
    const Tally tally = compare(press, tolerance);
    all.covered += tally.covered;
    all.values += tally.values;
  };
  for (const Tip& tip : tips)
    for (const double nu : {0.25, 0.43, 0.47, 0.49})
      for (const ContactMode contact : {ContactMode::frictionless, ContactMode::stick}) {
        add({tip,
             nu,
             contact,
             Strain::linear,
             {0.02, 0.04, 0.06, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6}},
            5e-3);
        if (nu == 0.43) add({tip, nu, contact, Strain::finite, {0.1, 0.2, 0.3, 0.4}}, 1e-2);
      }
  std::printf("%d of %d covered\n", all.covered, all.values);
  EXPECT_GE(all.values, 260);
  EXPECT_GE(all.covered, 0.95 * all.values);
}
