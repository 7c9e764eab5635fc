#include "calibration/material/moduli.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <random>

#include "meshes/rubber/rubber.h"
#include "tests/calibration/infinite_lattice.h"

namespace {

using fingertip::calibration::ElasticModuli;
using fingertip::calibration::homogenised_moduli;
using fingertip::calibration::moduli_from_stiffness;
using fingertip::calibration::youngs_modulus_along;
using fingertip::lattice::SpringConstants;

constexpr double gf_per_cm2 = 98.0665;  // [Pa]
constexpr double a = 8.0e-4;            // [m]

/// A cubic stiffness tensor C_ijkl, rotated and inverted by brute force.
double rotated_youngs_modulus(double c11, double c12, double c44, const Eigen::Vector3d& axis) {
  const auto c = [&](int i, int j, int k, int l) {
    if (i == j && k == l) return i == k ? c11 : c12;
    return (i == k && j == l) || (i == l && j == k) ? c44 : 0.0;
  };
  const Eigen::Matrix3d r =
      Eigen::Quaterniond::FromTwoVectors(axis, Eigen::Vector3d::UnitX()).toRotationMatrix();
  constexpr std::array<std::array<int, 2>, 6> voigt{
      {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}};
  Eigen::Matrix<double, 6, 6> rotated;
  for (int p = 0; p < 6; ++p)
    for (int q = 0; q < 6; ++q) {
      double sum = 0.0;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          for (int k = 0; k < 3; ++k)
            for (int l = 0; l < 3; ++l)
              sum += r(voigt[std::size_t(p)][0], i) * r(voigt[std::size_t(p)][1], j) *
                     r(voigt[std::size_t(q)][0], k) * r(voigt[std::size_t(q)][1], l) *
                     c(i, j, k, l);
      rotated(p, q) = sum;
    }
  return 1.0 / rotated.inverse()(0, 0);
}

SpringConstants random_constants(std::mt19937& generator) {
  std::uniform_real_distribution<double> k(0.1, 3.0), kappa(-200.0, 9000.0);
  return {k(generator), k(generator), k(generator), kappa(generator)};
}

TEST(Moduli, HomogenisationEqualsTheEnergyOfThePeriodicCellForRandomStrains) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> component(-1e-2, 1e-2);
  for (int trial = 0; trial < 20; ++trial) {
    const SpringConstants constants = random_constants(generator);
    const ElasticModuli m = homogenised_moduli(constants, a);
    Eigen::Matrix3d gradient;
    for (double& value : gradient.reshaped()) value = component(generator);
    const Eigen::Matrix3d e = 0.5 * (gradient + gradient.transpose());
    const double diagonal = e.diagonal().squaredNorm();
    const double trace = e.trace();
    const double shear = e(0, 1) * e(0, 1) + e(1, 2) * e(1, 2) + e(0, 2) * e(0, 2);
    const double expected =
        0.5 * (m.c11 * diagonal + m.c12 * (trace * trace - diagonal)) + 2.0 * m.c44 * shear;
    EXPECT_NEAR(infinite_lattice::energy_density(constants, a, e), expected, 1e-12 * expected);
  }
}

TEST(Moduli, DirectionalYoungsModulusEqualsRotatingTheStiffnessTensor) {
  const double c11 = 46.48, c12 = 14.0, c44 = 9.0;
  const ElasticModuli m = moduli_from_stiffness(c11, c12, c44);
  EXPECT_NEAR(m.youngs_modulus_100, rotated_youngs_modulus(c11, c12, c44, {1, 0, 0}), 1e-11);
  EXPECT_NEAR(m.youngs_modulus_110, rotated_youngs_modulus(c11, c12, c44, {1, 1, 0}), 1e-11);
  EXPECT_NEAR(m.youngs_modulus_111, rotated_youngs_modulus(c11, c12, c44, {1, 1, 1}), 1e-11);
  const Eigen::Vector3d odd(0.3, -1.7, 0.9);
  EXPECT_NEAR(youngs_modulus_along(m, odd), rotated_youngs_modulus(c11, c12, c44, odd), 1e-11);
  EXPECT_NEAR(youngs_modulus_along(m, 5.0 * odd), youngs_modulus_along(m, odd), 1e-12);
}

TEST(Moduli, IsotropicStiffnessGivesTheTextbookRelations) {
  const double lambda = 84.0, g = 14.0;
  const ElasticModuli m = moduli_from_stiffness(lambda + 2.0 * g, lambda, g);
  EXPECT_NEAR(m.anisotropy, 1.0, 1e-15);
  EXPECT_NEAR(m.youngs_modulus_100, 40.0, 1e-12);
  EXPECT_NEAR(m.youngs_modulus_110, 40.0, 1e-12);
  EXPECT_NEAR(m.youngs_modulus_111, 40.0, 1e-12);
  EXPECT_NEAR(m.poissons_ratio_100, 3.0 / 7.0, 1e-15);
  EXPECT_NEAR(m.bulk_modulus, 280.0 / 3.0, 1e-12);
}

TEST(Moduli, PapersConstantsAreTwoToThreeTimesTooStiff) {
  const fingertip::meshes::Rubber rubber;  // the paper's: E = 40, G = 14 gf/cm²
  const ElasticModuli m = homogenised_moduli(fingertip::lattice::published_constants(rubber, a), a);
  EXPECT_NEAR(m.youngs_modulus_100 / gf_per_cm2, 89.9, 0.1);
  EXPECT_NEAR(m.youngs_modulus_110 / gf_per_cm2, 124.5, 0.1);
  EXPECT_NEAR(m.youngs_modulus_111 / gf_per_cm2, 142.9, 0.1);
  EXPECT_NEAR(m.shear_modulus / gf_per_cm2, 59.1, 0.1);
  EXPECT_NEAR(m.c11 / rubber.youngs_modulus, 1.0 + std::sqrt(2.0) + 4.0 / (3.0 * std::sqrt(3.0)),
              1e-12);
}

TEST(Moduli, AxialFitAloneCanSucceedOnAWrongMaterial) {
  const ElasticModuli m = homogenised_moduli({28.0 * a, 0.0, 63.0 * a, 0.0}, a);
  EXPECT_NEAR(m.youngs_modulus_100, 40.0, 1e-12);
  EXPECT_NEAR(m.poissons_ratio_100, 3.0 / 7.0, 1e-14);
  EXPECT_NEAR(m.shear_modulus, 84.0, 1e-12);
}

TEST(Moduli, CentralSpringsObeyTheCauchyRelationWhateverTheirConstants) {
  std::mt19937 generator(5);
  for (int trial = 0; trial < 20; ++trial) {
    SpringConstants constants = random_constants(generator);
    constants.kappa = 0.0;
    EXPECT_DOUBLE_EQ(homogenised_moduli(constants, a).c12, homogenised_moduli(constants, a).c44);
    constants.k1 = constants.k2 + 8.0 / 3.0 * constants.k3;
    EXPECT_NEAR(homogenised_moduli(constants, a).anisotropy, 1.0, 1e-12);
    EXPECT_NEAR(homogenised_moduli(constants, a).poissons_ratio_100, 0.25, 1e-12);
  }
}

}  // namespace
