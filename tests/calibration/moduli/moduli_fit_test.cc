#include "calibration/moduli/moduli_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibration/moduli/cube_test.h"
#include "calibration/moduli/result_io.h"
#include "meshes/base/errors.h"
#include "tests/calibration/infinite_lattice.h"
#include "tests/calibration/moduli/mechanisms.h"
#include "tests/expectations.h"

namespace {

using fingertip::calibration::CubeModuli;
using fingertip::calibration::ElasticModuli;
using fingertip::calibration::fit_moduli;
using fingertip::calibration::homogenised_moduli;
using fingertip::calibration::ModuliFit;
using fingertip::calibration::ModuliFitOptions;
using fingertip::lattice::ModelKind;
using fingertip::lattice::SpringConstants;
using fingertip::meshes::InvalidInput;
using fingertip::meshes::Rubber;

constexpr double gf_per_cm2 = 98.0665;  // [Pa]
constexpr double a = 1.0e-2 / 12.0;     // [m]

Rubber rubber_of(double nu) {
  Rubber rubber;
  rubber.youngs_modulus = 2.0 * (1.0 + nu) * rubber.shear_modulus;
  return rubber;
}

ModuliFit fit(const Rubber& rubber, ModelKind model) {
  return fit_moduli(rubber, {.model = model, .spacing = a});
}

class HookeanFit : public testing::TestWithParam<double> {};

TEST_P(HookeanFit, ReachesEveryModulusIsotropically) {
  const Rubber rubber = rubber_of(GetParam());
  const ModuliFit result = fit(rubber, ModelKind::hookean);
  EXPECT_NEAR(result.achieved.youngs_modulus_100 / rubber.youngs_modulus, 1.0, 1e-9);
  EXPECT_NEAR(result.achieved.youngs_modulus_110 / rubber.youngs_modulus, 1.0, 1e-9);
  EXPECT_NEAR(result.achieved.youngs_modulus_111 / rubber.youngs_modulus, 1.0, 1e-9);
  EXPECT_NEAR(result.achieved.shear_modulus / rubber.shear_modulus, 1.0, 1e-9);
  EXPECT_NEAR(result.achieved.poissons_ratio_100, GetParam(), 1e-9);
  EXPECT_NEAR(result.achieved.bulk_modulus / rubber.bulk_modulus(), 1.0, 1e-9);
  EXPECT_NEAR(result.achieved.anisotropy, 1.0, 1e-9);
  // From the constants once more, and against the rubber's own.
  const ElasticModuli again = homogenised_moduli(result.constants, a);
  const double tolerance = 1e-8 * rubber.youngs_modulus;
  EXPECT_NEAR(again.c11, rubber.longitudinal_modulus(), tolerance);
  EXPECT_NEAR(again.c12, rubber.lame_lambda(), tolerance);
  EXPECT_NEAR(again.c44, rubber.shear_modulus, tolerance);
}

TEST_P(HookeanFit, FindsTheClosedForm) {
  const Rubber rubber = rubber_of(GetParam());
  const SpringConstants found = fit(rubber, ModelKind::hookean).constants;
  const SpringConstants exact = fingertip::lattice::hookean_constants(rubber, a);
  EXPECT_NEAR(found.k1 / exact.k1, 1.0, 1e-9);
  EXPECT_NEAR(found.k2 / exact.k2, 1.0, 1e-9);
  EXPECT_EQ(found.k3, 0.0);
  EXPECT_NEAR(found.kappa, exact.kappa, 1e-9 * (rubber.longitudinal_modulus()));
}

INSTANTIATE_TEST_SUITE_P(PoissonsRatios, HookeanFit,
                         testing::Values(-0.9, -0.3, 0.0, 0.25, 3.0 / 7.0, 0.499));

TEST(CentralFit, PapersRubberPaysForEAndGWithTheBulkModulus) {
  const Rubber rubber;
  const ModuliFit result = fit(rubber, ModelKind::central);
  EXPECT_NEAR(result.achieved.youngs_modulus_100 / rubber.youngs_modulus, 1.0, 1e-6);
  EXPECT_NEAR(result.achieved.shear_modulus / rubber.shear_modulus, 1.0, 1e-6);
  EXPECT_NEAR(result.achieved.poissons_ratio_100, 0.23, 0.005);
  EXPECT_NEAR(result.achieved.bulk_modulus / gf_per_cm2, 24.8, 0.05);
  EXPECT_NEAR(result.achieved.c11 / gf_per_cm2, 46.48, 0.005);
  EXPECT_NEAR(result.achieved.c44 / gf_per_cm2, 14.0, 1e-5);
  EXPECT_EQ(result.constants.k3, 0.0);
  EXPECT_EQ(result.constants.kappa, 0.0);
}

// E_100 = (C11 - G)(C11 + 2G)/(C11 + G) takes every positive value for C11 > G, and then
// non-negative springs exist: the targets are always attainable, the others never.
TEST(CentralFit, AttainsEAndGOfEveryRubberWithoutMechanisms) {
  for (const double nu : {-0.9, -0.5, -0.3, 0.0, 0.2, 0.25, 0.4, 0.499}) {
    const Rubber rubber = rubber_of(nu);
    const ModuliFit result = fit(rubber, ModelKind::central);
    EXPECT_NEAR(result.achieved.youngs_modulus_100 / rubber.youngs_modulus, 1.0, 1e-6) << nu;
    EXPECT_NEAR(result.achieved.shear_modulus / rubber.shear_modulus, 1.0, 1e-6) << nu;
    EXPECT_GT(result.constants.k1, 0.0) << nu;
    EXPECT_GT(result.constants.k2, 0.0) << nu;
    EXPECT_GE(result.constants.k3, 0.0) << nu;
    EXPECT_EQ(count_mechanisms(
                  fingertip::lattice::cube_lattice(ModelKind::central, result.constants, a, 1)),
              0)
        << nu;
  }
}

TEST(CentralFit, MatchesTheOneRubberOfNuOneQuarterCompletely) {
  const Rubber rubber = rubber_of(0.25);
  const ModuliFit result = fit(rubber, ModelKind::central);
  EXPECT_NEAR(result.achieved.bulk_modulus / rubber.bulk_modulus(), 1.0, 1e-9);
  EXPECT_NEAR(result.achieved.anisotropy, 1.0, 1e-9);
}

ModuliFit compromise(const Rubber& rubber, double isotropy, double bulk) {
  return fit_moduli(rubber, {.model = ModelKind::central,
                             .spacing = a,
                             .isotropy_weight = isotropy,
                             .bulk_weight = bulk});
}

/// Sum of squared residuals of springs with these moduli, written once more.
double loss(const Rubber& rubber, double isotropy, double bulk, double c11, double c44) {
  const ElasticModuli m = fingertip::calibration::moduli_from_stiffness(c11, c44, c44);
  const double e = m.youngs_modulus_100;
  return std::pow(e / rubber.youngs_modulus - 1.0, 2) +
         std::pow(c44 / rubber.shear_modulus - 1.0, 2) +
         isotropy * isotropy *
             (std::pow(m.youngs_modulus_110 / e - 1.0, 2) +
              std::pow(m.youngs_modulus_111 / e - 1.0, 2)) +
         bulk * bulk * std::pow(m.bulk_modulus / rubber.bulk_modulus() - 1.0, 2);
}

/// Every C44 > 0 and C11 > C44 belongs to non-negative springs, so the least loss can be sought
/// there: on a grid in their logarithms that closes in on its best point.
Eigen::Vector2d min_loss(const Rubber& rubber, double isotropy, double bulk) {
  Eigen::Vector2d best(std::log(2.0 * rubber.shear_modulus), std::log(rubber.shear_modulus));
  const auto at = [&](const Eigen::Vector2d& logs) {
    const double c44 = std::exp(logs(1));
    return loss(rubber, isotropy, bulk, c44 + std::exp(logs(0)), c44);
  };
  for (double width = 4.0; width > 1e-8; width *= 0.8) {
    const Eigen::Vector2d centre = best;
    for (int i = -10; i <= 10; ++i)
      for (int j = -10; j <= 10; ++j) {
        const Eigen::Vector2d other = centre + width / 10.0 * Eigen::Vector2d(i, j);
        if (at(other) < at(best)) best = other;
      }
  }
  const double c44 = std::exp(best(1));
  return {c44 + std::exp(best(0)), c44};
}

TEST(CentralCompromise, IsTheLeastLossThatAnySpringsHave) {
  for (const double nu : {-0.9, -0.3, 0.0, 3.0 / 7.0, 0.499})
    for (const auto& [isotropy, bulk] :
         {std::pair{1.0, 0.0}, {0.0, 0.1}, {0.3, 1.0}, {10.0, 3.0}}) {
      SCOPED_TRACE(testing::Message() << nu << " " << isotropy << " " << bulk);
      const Rubber rubber = rubber_of(nu);
      const ModuliFit result = compromise(rubber, isotropy, bulk);
      const Eigen::Vector2d best = min_loss(rubber, isotropy, bulk);
      EXPECT_NEAR(result.achieved.c11 / best(0), 1.0, 1e-5);
      EXPECT_NEAR(result.achieved.c44 / best(1), 1.0, 1e-5);
      EXPECT_LE(loss(rubber, isotropy, bulk, result.achieved.c11, result.achieved.c44),
                loss(rubber, isotropy, bulk, best(0), best(1)) * (1.0 + 1e-12));
      EXPECT_GE(std::min({result.constants.k1, result.constants.k2, result.constants.k3}), 0.0);
    }
}

// Isotropic springs have E = 5/2 G; of these the weight leaves the one whose E and G miss least.
TEST(CentralCompromise, LargeWeightsEndAtIsotropyOrAtTheBulkModulus) {
  const Rubber rubber;
  const ModuliFit isotropic = compromise(rubber, 1e4, 0.0);
  const double e = rubber.youngs_modulus, g = rubber.shear_modulus;
  const double expected = (2.5 / e + 1.0 / g) / (6.25 / (e * e) + 1.0 / (g * g));
  EXPECT_NEAR(isotropic.achieved.anisotropy, 1.0, 1e-6);
  EXPECT_NEAR(isotropic.achieved.poissons_ratio_100, 0.25, 1e-6);
  EXPECT_NEAR(isotropic.achieved.shear_modulus / expected, 1.0, 1e-6);
  const ModuliFit bulky = compromise(rubber, 0.0, 1e4);
  EXPECT_NEAR(bulky.achieved.bulk_modulus / rubber.bulk_modulus(), 1.0, 1e-6);
  EXPECT_GT(bulky.achieved.youngs_modulus_100, 1.2 * e);
}

TEST(CentralCompromise, TradesMoreTheLargerTheWeight) {
  double bulk = 0.0, error = -1.0, anisotropy = 0.0;
  for (const double weight : {0.0, 0.05, 0.2, 1.0, 5.0}) {
    const ModuliFit volume = compromise(Rubber{}, 0.0, weight);
    EXPECT_GT(volume.achieved.bulk_modulus, bulk);
    const double missed = std::hypot(*volume.residuals.find("E_100"), *volume.residuals.find("G"));
    EXPECT_GT(missed, error);
    bulk = volume.achieved.bulk_modulus;
    error = missed;
    const ModuliFit shape = compromise(Rubber{}, weight, 0.0);
    EXPECT_GT(shape.achieved.anisotropy, anisotropy);
    anisotropy = shape.achieved.anisotropy;
  }
  EXPECT_LT(anisotropy, 1.0);
}

TEST(CentralCompromise, CostsNothingWhereNothingIsOutOfReach) {
  const Rubber rubber = rubber_of(0.25);
  const ModuliFit result = compromise(rubber, 1.0, 1.0);
  for (const auto& [name, residual] : result.residuals) EXPECT_NEAR(residual, 0.0, 1e-9) << name;
  const std::string said = fit_statement(result);
  EXPECT_TRUE(says(said, "all reached"));
  // hookean meets everything, so weights mean nothing to it.
  const ModuliFit plain = fit(Rubber{}, ModelKind::hookean);
  const ModuliFit weighted = fit_moduli(Rubber{}, {.spacing = a, .isotropy_weight = 2.0});
  EXPECT_EQ(weighted.constants.k1, plain.constants.k1);
  EXPECT_EQ(fit_statement(weighted), fit_statement(plain));
}

TEST(CentralCompromise, StatementSaysWhatIsOutOfReachAndWhatWasTraded) {
  const ModuliFit result = compromise(Rubber{}, 1.0, 0.1);
  std::vector<std::string> names;
  for (const auto& [name, residual] : result.residuals) names.push_back(name);
  EXPECT_EQ(names, (std::vector<std::string>{"E_100", "G", "E_110/E_100", "E_111/E_100", "K"}));
  const std::string said = fit_statement(result);
  EXPECT_TRUE(says(said, {"Cauchy", "nu = 0.4286", "out of reach together", "(isotropy 1, bulk",
                          "E_100 = 3729.1 Pa instead of 3922.7 Pa (-4.94 %)", "Traded",
                          "K = 2434.7 Pa instead of 9152.9 Pa (-73.4 %)", "anisotropy 0.862"}));
}

TEST(ModuliFit, FiniteCubesOfTheFittedLatticesMeasureTheTargets) {
  for (const ModelKind model : {ModelKind::hookean, ModelKind::central}) {
    const Rubber rubber;
    const ModuliFit result = fit(rubber, model);
    const CubeModuli cube = fingertip::calibration::measure_cube(
        fingertip::lattice::cube_lattice(model, result.constants, a, 4));
    EXPECT_NEAR(cube.youngs_modulus_100 / rubber.youngs_modulus, 1.0, 1e-9);
    EXPECT_NEAR(cube.youngs_modulus_111 / result.achieved.youngs_modulus_111, 1.0, 1e-9);
    EXPECT_NEAR(cube.shear_modulus / rubber.shear_modulus, 1.0, 1e-9);
    EXPECT_NEAR(cube.bulk_modulus / result.achieved.bulk_modulus, 1.0, 1e-9);
  }
}

TEST(ModuliFit, NamesTheOneDirectionThatChangesNoModulus) {
  const Eigen::Vector4d open = fingertip::calibration::open_direction();
  EXPECT_LT((open / open(0) - Eigen::Vector4d(1.0, -1.0, 0.75, 0.0)).norm(), 1e-15);
  EXPECT_STREQ(fingertip::calibration::open_direction_words, "k1 + 1, k2 - 1, k3 + 0.75");
  for (const ModelKind model : {ModelKind::hookean, ModelKind::central}) {
    const ModuliFit result = fit(Rubber{}, model);
    const Eigen::Vector4d t = 0.1 * result.constants.k2 * open;
    SpringConstants moved = result.constants;
    moved.k1 += t(0), moved.k2 += t(1), moved.k3 += t(2), moved.kappa += t(3);
    const ElasticModuli found = homogenised_moduli(moved, a);
    EXPECT_NEAR(found.c11, result.achieved.c11, 1e-12 * result.achieved.c11);
    EXPECT_NEAR(found.c12, result.achieved.c12, 1e-12 * result.achieved.c11);
    EXPECT_NEAR(found.c44, result.achieved.c44, 1e-12 * result.achieved.c11);
  }
}

// Of the family of equal fits, k3 = 0 leaves every short wave as stiff as a shear wave along a cube
// axis; at the other end, k3 = 3aG/4, u_x = (-1)^(j+k) costs nothing.
TEST(ModuliFit, ChosenConstantsHaveNoSoftShortWaves) {
  for (const double nu : {-0.3, 0.0, 3.0 / 7.0, 0.499}) {
    const Rubber rubber = rubber_of(nu);
    const double ga = rubber.shear_modulus * a;
    const SpringConstants chosen = fit(rubber, ModelKind::hookean).constants;
    EXPECT_NEAR(infinite_lattice::softest_zone_boundary_wave(chosen, a), 4.0 * ga, 1e-6 * ga) << nu;
    const auto softest = [&](double k3) {
      return infinite_lattice::softest_zone_boundary_wave(
                 {ga + 4.0 / 3.0 * k3, ga - 4.0 / 3.0 * k3, k3, chosen.kappa}, a) /
             ga;
    };
    EXPECT_NEAR(softest(0.375 * ga), 4.0, 1e-6) << nu;
    EXPECT_NEAR(softest(0.5 * ga), 8.0 / 3.0, 1e-6) << nu;
    EXPECT_NEAR(softest(0.75 * ga), 0.0, 1e-9) << nu;
  }
}

TEST(ModuliFit, ConstantsGrowWithTheSpacing) {
  const ModuliFit first = fit(Rubber{}, ModelKind::central);
  const ModuliFit coarse = fit_moduli(Rubber{}, {.model = ModelKind::central, .spacing = 2.0 * a});
  EXPECT_NEAR(coarse.constants.k1 / first.constants.k1, 2.0, 1e-9);
  EXPECT_NEAR(coarse.constants.k2 / first.constants.k2, 2.0, 1e-9);
}

TEST(ModuliFit, IsQuiet) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  fit(Rubber{}, ModelKind::central);
  compromise(rubber_of(-0.9), 1.0, 1.0);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(ModuliFit, StatementExplainsThePrice) {
  const std::string central = fit_statement(fit(Rubber{}, ModelKind::central));
  EXPECT_TRUE(says(central, {"Cauchy", "nu_100 = 0.2315", "K = 2434", "instead of 9152.9 Pa",
                             "k1 + 1, k2 - 1, k3 + 0.75", "out of reach"}));
  const std::string hookean = fit_statement(fit(Rubber{}, ModelKind::hookean));
  EXPECT_TRUE(says(hookean, "every direction"));
  EXPECT_TRUE(says(fit_statement(fit(rubber_of(0.25), ModelKind::central)), "costs nothing"));
}

void expect_refused(const Rubber& rubber, const ModuliFitOptions& options, const std::string& key) {
  try {
    fit_moduli(rubber, options);
    FAIL() << "accepted " << key;
  } catch (const InvalidInput& error) {
    ASSERT_FALSE(error.violations().empty());
    EXPECT_EQ(error.violations()[0].key, key);
    EXPECT_FALSE(error.violations()[0].remedy.empty());
  }
}

TEST(ModuliFit, SaysWhyNoBodyHasALargerPoissonsRatio) {
  Rubber rubber;
  rubber.shear_modulus = 0.3 * rubber.youngs_modulus;
  try {
    fit(rubber, ModelKind::hookean);
    FAIL();
  } catch (const InvalidInput& error) {
    const std::string text = error.what();
    EXPECT_TRUE(says(text, {"G must exceed E/3", "no lattice and no continuum"}));
  }
}

TEST(ModuliFit, RefusesWhatItCannotFit) {
  const ModuliFitOptions good{.model = ModelKind::hookean, .spacing = a};
  ModuliFitOptions bad = good;
  bad.model = ModelKind::published;
  expect_refused(Rubber{}, bad, "lattice.model");
  for (const double spacing : {0.0, -a, std::numeric_limits<double>::quiet_NaN()}) {
    bad = good;
    bad.spacing = spacing;
    expect_refused(Rubber{}, bad, "lattice.spacing");
  }
  Rubber too_soft_in_shear;
  too_soft_in_shear.shear_modulus = too_soft_in_shear.youngs_modulus / 3.0;
  expect_refused(too_soft_in_shear, good, "rubber.shear_modulus");
  for (const double weight : {-1.0, std::numeric_limits<double>::infinity()}) {
    bad = good;
    bad.isotropy_weight = weight;
    expect_refused(Rubber{}, bad, "calibration.isotropy_weight");
    bad = good;
    bad.bulk_weight = weight;
    expect_refused(Rubber{}, bad, "calibration.bulk_weight");
  }
}

}  // namespace
