#include "meshes/rubber/rubber.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "meshes/rubber/plausible.h"

using namespace fingertip::meshes;

namespace {

constexpr double gf_per_cm2 = 98.0665;  // [Pa], by definition of standard gravity

TEST(Rubber, DefaultIsThePapersRubber) {
  const Rubber rubber;
  EXPECT_NEAR(rubber.youngs_modulus / gf_per_cm2, 40.0, 1e-12);
  EXPECT_NEAR(rubber.shear_modulus / gf_per_cm2, 14.0, 1e-12);
  EXPECT_NEAR(rubber.poissons_ratio(), 3.0 / 7.0, 1e-14);
  EXPECT_NEAR(rubber.lame_lambda() / gf_per_cm2, 84.0, 1e-10);
  EXPECT_NEAR(rubber.bulk_modulus() / gf_per_cm2, 280.0 / 3.0, 1e-10);
}

TEST(Rubber, ModuliAreConsistentForEveryAdmissiblePoissonsRatio) {
  for (const double nu : {-0.9, -0.3, 0.0, 0.25, 0.4286, 0.499}) {
    Rubber rubber;
    rubber.shear_modulus = rubber.youngs_modulus / (2.0 * (1.0 + nu));
    const double e = rubber.youngs_modulus;
    EXPECT_TRUE(rubber.violations().empty()) << nu;
    EXPECT_NEAR(rubber.poissons_ratio(), nu, 1e-12);
    EXPECT_NEAR(rubber.bulk_modulus() * 3.0 * (1.0 - 2.0 * nu) / e, 1.0, 1e-10) << nu;
    EXPECT_NEAR(rubber.longitudinal_modulus() * (1.0 + nu) * (1.0 - 2.0 * nu) / (e * (1.0 - nu)),
                1.0, 1e-10);
    EXPECT_NEAR(std::pow(rubber.shear_wave_speed(), 2) * rubber.density, rubber.shear_modulus,
                1e-9);
  }
}

TEST(Rubber, SlopesOfLambdaMeetDifferences) {
  const auto lambda_of = [](double e, double g) {
    Rubber rubber;
    rubber.youngs_modulus = e;
    rubber.shear_modulus = g;
    return rubber.lame_lambda();
  };
  Rubber rubber;
  const double e = rubber.youngs_modulus = 4.0, g = rubber.shear_modulus = 1.5, h = 1e-5;
  const Eigen::RowVector2d slopes = rubber.lambda_slopes();
  EXPECT_NEAR(slopes(0), (lambda_of(e + h, g) - lambda_of(e - h, g)) / (2.0 * h), 1e-8);
  EXPECT_NEAR(slopes(1), (lambda_of(e, g + h) - lambda_of(e, g - h)) / (2.0 * h), 1e-7);
}

TEST(Rubber, RefusesShearModulusAtOrBelowAThirdOfYoungs) {
  for (const double ratio : {0.2, 1.0 / 3.0}) {
    Rubber rubber;
    rubber.shear_modulus = ratio * rubber.youngs_modulus;
    ASSERT_EQ(rubber.violations().size(), 1u);
    EXPECT_EQ(rubber.violations()[0].key, "rubber.shear_modulus");
    EXPECT_NE(rubber.violations()[0].rule.find("E/3"), std::string::npos);
  }
}

TEST(Rubber, RefusesAPoissonsRatioThatRoundsToMinusOne) {
  EXPECT_FALSE((Rubber{1e-12, 1e4, 500.0, 0.0, {}, {}}.violations().empty()));
  const Rubber odd{1e-3, 1e4, 500.0, 0.0, {}, {}};  // nu = -1 + 5e-8
  EXPECT_TRUE(odd.violations().empty());
  EXPECT_GT(odd.poissons_ratio(), -1.0);
}

TEST(Rubber, ModuliThatNoRubberHasAreToldWithWhatWasMeant) {
  for (const double plausible : {1e3, 3922.66, 6e4, 1e8, 0.0, -1.0, double(NAN), double(INFINITY)})
    EXPECT_EQ(implausible_modulus(plausible), "") << plausible;
  const auto says = [](double modulus, const char* own, const char* meant) {
    const std::string text = implausible_modulus(modulus);
    EXPECT_NE(text.find(own), text.npos) << text;
    EXPECT_NE(text.find(meant), text.npos) << text;
  };
  says(60.0, "E = 60 Pa is no rubber's", "by a factor of 1000, and 60 kPa is meant");
  says(6e10, "E = 60 GPa is no rubber's", "by a factor of 1000, and 60 MPa is meant");
  says(0.06, "E = 0.06 Pa", "by a factor of 1000000, and 60 kPa is meant");
  says(2.5e8, "E = 250 MPa", "and 250 kPa is meant");
}

TEST(Rubber, RefusesWhatIsNotANumber) {
  Rubber rubber;
  rubber.density = std::nan("");
  rubber.retardation_time = -1.0;
  EXPECT_EQ(rubber.violations().size(), 2u);
}

}  // namespace
