#include "calibration/moduli_fit.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>

#include "calibration/cube_test.h"
#include "calibration/fit_statement.h"
#include "infinite_lattice.h"
#include "meshes/errors.h"

namespace {

using fingertip::calibration::CubeModuli;
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

ModuliFit fit(const Rubber& rubber, ModelKind model, unsigned seed = 1) {
  return fit_moduli(rubber, {.model = model, .spacing = a, .starts = 10, .seed = seed});
}

class HookeanFit : public testing::TestWithParam<double> {};

TEST_P(HookeanFit, ReachesEveryModulusIsotropicallyFromEveryStart) {
  const Rubber rubber = rubber_of(GetParam());
  const auto start = std::chrono::steady_clock::now();
  const ModuliFit result = fit(rubber, ModelKind::hookean);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;

  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.starts_agreeing, 10);
  EXPECT_NEAR(result.achieved.youngs_modulus_100 / rubber.youngs_modulus, 1.0, 1e-9);
  EXPECT_NEAR(result.achieved.youngs_modulus_110 / rubber.youngs_modulus, 1.0, 1e-9);
  EXPECT_NEAR(result.achieved.youngs_modulus_111 / rubber.youngs_modulus, 1.0, 1e-9);
  EXPECT_NEAR(result.achieved.shear_modulus / rubber.shear_modulus, 1.0, 1e-9);
  EXPECT_NEAR(result.achieved.poissons_ratio_100, GetParam(), 1e-9);
  EXPECT_NEAR(result.achieved.bulk_modulus / rubber.bulk_modulus(), 1.0, 1e-9);
  EXPECT_NEAR(result.achieved.anisotropy, 1.0, 1e-9);
  EXPECT_LT(elapsed.count(), 1.0);
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
  EXPECT_EQ(result.starts_agreeing, 10);
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
    EXPECT_EQ(result.starts_agreeing, 10) << nu;
    EXPECT_EQ(fingertip::calibration::count_mechanisms(
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
  for (const ModelKind model : {ModelKind::hookean, ModelKind::central}) {
    const ModuliFit result = fit(Rubber{}, model);
    ASSERT_EQ(result.unidentifiable.size(), 1u);
    const Eigen::Vector4d expected = Eigen::Vector4d(4.0, -4.0, 3.0, 0.0) / std::sqrt(41.0);
    EXPECT_LT((result.unidentifiable[0] - expected).norm(), 1e-9);
    EXPECT_EQ(fingertip::calibration::describe_direction(result.unidentifiable[0]),
              "k1 + 1, k2 - 1, k3 + 0.75");

    const double t = 0.1 * result.constants.k2;
    SpringConstants moved = result.constants;
    moved.k1 += 4.0 / 3.0 * t;
    moved.k2 -= 4.0 / 3.0 * t;
    moved.k3 += t;
    EXPECT_NEAR(homogenised_moduli(moved, a).youngs_modulus_111, result.achieved.youngs_modulus_111,
                1e-12 * result.achieved.youngs_modulus_111);
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

TEST(ModuliFit, ResultDependsNeitherOnTheSeedNorOnTheSpacing) {
  const ModuliFit first = fit(Rubber{}, ModelKind::central, 1);
  const ModuliFit second = fit(Rubber{}, ModelKind::central, 99);
  EXPECT_NEAR(first.constants.k1 / second.constants.k1, 1.0, 1e-9);
  const ModuliFit coarse = fit_moduli(Rubber{}, {.model = ModelKind::central, .spacing = 2.0 * a});
  EXPECT_NEAR(coarse.constants.k1 / first.constants.k1, 2.0, 1e-9);
  EXPECT_NEAR(coarse.constants.k2 / first.constants.k2, 2.0, 1e-9);
}

TEST(ModuliFit, IsQuiet) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  fit(Rubber{}, ModelKind::central);
  fit(rubber_of(-0.9), ModelKind::hookean);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(ModuliFit, StatementExplainsThePrice) {
  const std::string central = fit(Rubber{}, ModelKind::central).statement;
  EXPECT_NE(central.find("Cauchy"), std::string::npos);
  EXPECT_NE(central.find("nu_100 = 0.2315"), std::string::npos) << central;
  EXPECT_NE(central.find("K = 2434"), std::string::npos) << central;
  EXPECT_NE(central.find("instead of 9152.9 Pa"), std::string::npos) << central;
  EXPECT_NE(central.find("k1 + 1, k2 - 1, k3 + 0.75"), std::string::npos) << central;
  EXPECT_NE(central.find("10 of 10 random starts"), std::string::npos) << central;
  const std::string hookean = fit(Rubber{}, ModelKind::hookean).statement;
  EXPECT_NE(hookean.find("every direction"), std::string::npos) << hookean;
  EXPECT_NE(fit(rubber_of(0.25), ModelKind::central).statement.find("costs nothing"),
            std::string::npos);
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
  bad = good;
  bad.starts = 0;
  expect_refused(Rubber{}, bad, "calibration.starts");
  Rubber too_soft_in_shear;
  too_soft_in_shear.shear_modulus = too_soft_in_shear.youngs_modulus / 3.0;
  expect_refused(too_soft_in_shear, good, "rubber.shear_modulus");
}

}  // namespace
