#include "tests/verification/error_bars.h"

using namespace error_bars;

TEST(ErrorBars, ReachIndependentSolutionsInNineteenOfTwentyCases) {
  Tally all;
  for (const Tip& tip : tips)
    for (const double nu : {0.25, 0.43, 0.47, 0.49})
      for (const ContactMode contact : {ContactMode::frictionless, ContactMode::stick}) {
        all += compare({tip,
                        nu,
                        contact,
                        Strain::linear,
                        {0.02, 0.04, 0.06, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6}},
                       5e-3);
        if (nu == 0.43)
          all += compare({tip, nu, contact, Strain::finite, {0.1, 0.2, 0.3, 0.4}}, 1e-2);
      }
  all.print();
  EXPECT_GE(all.values, 260);
  EXPECT_GE(all.covered, 0.95 * all.values);
}

/// Every contact and law on the meridian, against elements of degree 3 at a tenth of the tolerance.
TEST(ErrorBars, ReachFinerSolutionsInNineteenOfTwentyCases) {
  Tally all;
  for (const Tip& tip : {tips[0], tips[2]})
    for (const double nu : {0.25, 0.43, 0.47, 0.49})
      for (const ContactMode contact :
           {ContactMode::frictionless, ContactMode::stick, ContactMode::coulomb})
        for (const auto& [strain, law] :
             {std::pair(Strain::linear, VolumetricLaw::logarithmic),
              std::pair(Strain::finite, VolumetricLaw::logarithmic),
              std::pair(Strain::finite, VolumetricLaw::full_quadratic),
              std::pair(Strain::finite, VolumetricLaw::isochoric_logarithmic)})
          all += compare_with_finer({tip, nu, contact, strain, {0.05, 0.1, 0.2, 0.3, 0.4}, law});
  all.print();
  EXPECT_EQ(all.values, 480);
  EXPECT_GE(all.covered, 0.95 * all.values);
  EXPECT_LE(all.median_idleness(), 5.0);
}
