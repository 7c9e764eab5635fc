#include "calibration/press_fit/rig_estimates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "meshes/base/errors.h"

namespace {

using namespace fingertip;
using namespace fingertip::calibration;

/// A rigid blank: no force to 0.2 mm, then F = (x - 0.2 mm)/c with c = 0.05 mm/N up to 10 N.
Curve blank(double noise, unsigned seed, double stiffening = 0.0) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Curve curve;
  curve.name = "blank";
  curve.is_travel = true;
  for (int i = -20; i <= 100; ++i) {
    const double travel = 5e-6 * i, force = std::max(0.0, travel) / 5e-5;
    curve.x.push_back(0.2e-3 + travel);
    curve.y.push_back(force * (1.0 + stiffening * force / 10.0) + noise * normal(random));
  }
  return curve;
}

}  // namespace

/// 95 % of 200 seeds, within three deviations of a count of 190.
TEST(RigEstimates, ABlankTellsTheComplianceAndHowSureThatIs) {
  int inside = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Prior found = compliance_of_blank(blank(0.05, seed));
    inside += std::abs(found.mean - 5e-5) < 1.96 * found.deviation ? 1 : 0;
  }
  EXPECT_GE(inside, 181);
  EXPECT_LE(inside, 199);
  EXPECT_NEAR(compliance_of_blank(blank(0.0, 0)).mean, 5e-5, 1e-15);
  // One that stiffens has no single compliance: the secants of its halves lie within the interval.
  const Prior bent = compliance_of_blank(blank(0.0, 0, 0.2));
  EXPECT_GT(bent.deviation, 0.02 * bent.mean);
  Curve turned = blank(0.0, 0);
  for (double& x : turned.x) x = -x;
  EXPECT_THROW(compliance_of_blank(turned), meshes::InvalidInput);
}
