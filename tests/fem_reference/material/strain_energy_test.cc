#include "fem_reference/material/strain_energy.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "meshes/errors.h"

using namespace fingertip;
using Eigen::Matrix3d;
using fem_reference::HyperelasticLaw;
using fem_reference::PointResponse;
using fem_reference::StrainEnergy;

namespace {

constexpr StrainEnergy all_laws[] = {StrainEnergy::law_a, StrainEnergy::law_b, StrainEnergy::law_c};
constexpr double gf_per_cm2 = 98.0665;

/// The paper's rubber with the unit gf/cm², in which its figures are round.
meshes::Rubber rubber() {
  meshes::Rubber result;
  result.youngs_modulus = 40.0;
  result.shear_modulus = 14.0;
  return result;
}

/// Deformation gradients of strains up to about 1/2 in all directions, det F > 0.1.
std::vector<Matrix3d> random_deformations(int count) {
  std::mt19937 engine(20240611);
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  std::vector<Matrix3d> result;
  while (int(result.size()) < count) {
    const Matrix3d F =
        Matrix3d::Identity() + Matrix3d::NullaryExpr([&] { return uniform(engine); });
    if (F.determinant() > 0.1) result.push_back(F);
  }
  return result;
}

Matrix3d random_rotation(unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  const Eigen::Quaterniond q(normal(engine), normal(engine), normal(engine), normal(engine));
  return q.normalized().toRotationMatrix();
}

/// The energies as the docstring prints them, by Eigen's determinant.
double printed_energy(StrainEnergy law, const Matrix3d& F) {
  const double G = rubber().shear_modulus, lambda = rubber().lame_lambda();
  const double J = F.determinant(), I1 = (F.transpose() * F).trace(), log = std::log(J);
  switch (law) {
    case StrainEnergy::law_a: return G / 2 * (I1 - 3 - 2 * log) + lambda / 2 * log * log;
    case StrainEnergy::law_b: return G / 2 * (I1 - 3 - 2 * log) + lambda / 2 * (J - 1) * (J - 1);
    case StrainEnergy::law_c:
      return G / 2 * (I1 / std::pow(J, 2.0 / 3) - 3) + rubber().bulk_modulus() / 2 * log * log;
  }
  return 0.0;
}

Matrix3d with(Matrix3d F, int i, int J, double change) {
  F(i, J) += change;
  return F;
}

/// Stress and tangent of `part` against central differences of its energy and stress.
template <class Part>
void expect_derivatives(const Part& part, const Matrix3d& F) {
  const double step = 1e-5, scale = 1e2;
  const PointResponse here = part(F);
  for (int k = 0; k < 3; ++k)
    for (int L = 0; L < 3; ++L) {
      const PointResponse up = part(with(F, k, L, step)), down = part(with(F, k, L, -step));
      EXPECT_NEAR(here.stress(k, L), (up.energy - down.energy) / (2 * step), 1e-6 * scale);
      for (int i = 0; i < 3; ++i)
        for (int J = 0; J < 3; ++J)
          EXPECT_NEAR(here.tangent(3 * i + J, 3 * k + L),
                      (up.stress(i, J) - down.stress(i, J)) / (2 * step),
                      1e-6 * std::max(scale, here.tangent.cwiseAbs().maxCoeff()));
    }
}

TEST(StrainEnergy, IsThePrintedFormula) {
  for (const StrainEnergy law : all_laws)
    for (const Matrix3d& F : random_deformations(20))
      EXPECT_NEAR(HyperelasticLaw(law, rubber()).complete(F).energy, printed_energy(law, F), 1e-11);
}

TEST(StrainEnergy, StressAndTangentAreDerivatives) {
  for (const StrainEnergy law : all_laws) {
    const HyperelasticLaw material(law, rubber());
    for (const Matrix3d& F : random_deformations(10)) {
      expect_derivatives([&](const Matrix3d& X) { return material.complete(X); }, F);
      expect_derivatives([&](const Matrix3d& X) { return material.pointwise(X); }, F);
    }
  }
}

TEST(StrainEnergy, PartsMakeTheWhole) {
  for (const StrainEnergy law : all_laws) {
    const HyperelasticLaw material(law, rubber());
    for (const Matrix3d& F : random_deformations(10)) {
      const double J = F.determinant(), m = material.volumetric_modulus(), step = 1e-5;
      const auto h = material.volumetric(J);
      const auto up = material.volumetric(J + step), down = material.volumetric(J - step);
      EXPECT_NEAR(h.first, (up.value - down.value) / (2 * step), 1e-6);
      EXPECT_NEAR(h.second, (up.first - down.first) / (2 * step), 1e-4);
      const PointResponse part = material.pointwise(F), whole = material.complete(F);
      EXPECT_NEAR(whole.energy, part.energy + m / 2 * h.value * h.value, 1e-11);
      const Matrix3d volumetric = m * h.value * h.first * J * F.inverse().transpose();
      EXPECT_LT((whole.stress - part.stress - volumetric).norm(), 1e-10 * whole.stress.norm());
    }
  }
}

TEST(StrainEnergy, DoesNotSeeRotationsOfSpaceOrMaterial) {
  for (const StrainEnergy law : all_laws) {
    const HyperelasticLaw material(law, rubber());
    unsigned seed = 1;
    for (const Matrix3d& F : random_deformations(10)) {
      const Matrix3d Q = random_rotation(seed++);
      const PointResponse plain = material.complete(F);
      const PointResponse space = material.complete(Q * F), body = material.complete(F * Q);
      const double tolerance = 1e-12 * (1 + plain.stress.norm());
      EXPECT_NEAR(space.energy, plain.energy, tolerance);
      EXPECT_NEAR(body.energy, plain.energy, tolerance);
      EXPECT_LT((space.stress - Q * plain.stress).norm(), tolerance);
      EXPECT_LT((body.stress - plain.stress * Q).norm(), tolerance);
    }
  }
}

TEST(StrainEnergy, RestsWithoutStressWhereHookeHolds) {
  const double G = rubber().shear_modulus, lambda = rubber().lame_lambda();
  Eigen::Matrix<double, 9, 9> hooke;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l)
          hooke(3 * i + j, 3 * k + l) =
              lambda * (i == j) * (k == l) + G * ((i == k) * (j == l) + (i == l) * (j == k));
  for (const StrainEnergy law : all_laws) {
    const HyperelasticLaw material(law, rubber());
    for (const Matrix3d& F : {Matrix3d(Matrix3d::Identity()), random_rotation(7)}) {
      EXPECT_NEAR(material.complete(F).energy, 0.0, 1e-12);
      EXPECT_LT(material.complete(F).stress.norm(), 1e-12);
      EXPECT_LT(material.pointwise(F).stress.norm(), 1e-12);
    }
    const auto tangent = material.complete(Matrix3d::Identity()).tangent;
    EXPECT_LT((tangent - hooke).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(StrainEnergy, TangentHasMajorSymmetryAndCauchyStressIsSymmetric) {
  for (const StrainEnergy law : all_laws) {
    const HyperelasticLaw material(law, rubber());
    for (const Matrix3d& F : random_deformations(10)) {
      const PointResponse response = material.complete(F);
      const double scale = response.tangent.cwiseAbs().maxCoeff();
      EXPECT_LT((response.tangent - response.tangent.transpose()).cwiseAbs().maxCoeff(),
                1e-14 * scale);
      const Matrix3d sigma = material.cauchy_stress(F);
      EXPECT_LT((sigma - response.stress * F.transpose() / F.determinant()).norm(), 1e-14 * scale);
      EXPECT_LT((sigma - sigma.transpose()).norm(), 1e-14 * sigma.norm());
    }
  }
}

/// Nominal stress of a bar at `stretch`, its lateral stretch found so that the sides are free.
double uniaxial_stress(const HyperelasticLaw& material, double stretch) {
  const auto at = [&](double lateral) {
    const Eigen::Vector3d stretches(stretch, lateral, lateral);
    return material.complete(stretches.asDiagonal());
  };
  double narrow = 0.5, wide = 1.5;
  for (int i = 0; i < 60; ++i) {
    const double middle = (narrow + wide) / 2;
    (at(middle).stress(1, 1) < 0 ? narrow : wide) = middle;
  }
  return at(narrow).stress(0, 0);
}

/// The figures of law A come from an independent solution of its scalar equation.
TEST(StrainEnergy, UniaxialTestOfLawA) {
  meshes::Rubber paper;  // SI
  paper.youngs_modulus = 40 * gf_per_cm2;
  paper.shear_modulus = 14 * gf_per_cm2;
  const HyperelasticLaw material(StrainEnergy::law_a, paper);
  const double stretches[] = {0.8, 0.9, 1.1, 1.2, 1.5};
  const double expected[] = {-9.931, -4.416, 3.677, 6.838, 14.460};  // gf/cm²
  for (int i = 0; i < 5; ++i)
    EXPECT_NEAR(uniaxial_stress(material, stretches[i]) / gf_per_cm2, expected[i], 6e-4);
}

TEST(StrainEnergy, SmallUniaxialStrainGivesYoungsModulus) {
  for (const StrainEnergy law : all_laws) {
    const HyperelasticLaw material(law, rubber());
    const double e = 1e-5;
    const double slope =
        (uniaxial_stress(material, 1 + e) - uniaxial_stress(material, 1 - e)) / (2 * e);
    EXPECT_NEAR(slope, rubber().youngs_modulus, 1e-6 * 40);
  }
}

/// Simple shear keeps the volume: tau = G gamma. With laws A and B the only normal stress is
/// G gamma² along the shear; law C takes a third of it from all directions.
TEST(StrainEnergy, SimpleShear) {
  const double G = rubber().shear_modulus, gamma = 0.7;
  const Matrix3d F = with(Matrix3d::Identity(), 0, 1, gamma);
  for (const StrainEnergy law : all_laws) {
    const HyperelasticLaw material(law, rubber());
    Matrix3d expected = Matrix3d::Zero();
    expected(0, 1) = expected(1, 0) = G * gamma;
    expected(0, 0) = G * gamma * gamma;
    if (law == StrainEnergy::law_c) expected -= G * gamma * gamma / 3 * Matrix3d::Identity();
    EXPECT_LT((material.cauchy_stress(F) - expected).norm(), 1e-12);
    EXPECT_NEAR(material.complete(F).stress(0, 1), G * gamma, 1e-12);
  }
}

TEST(StrainEnergy, GrowsAsTheDocstringSays) {
  const double G = rubber().shear_modulus, lambda = rubber().lame_lambda(),
               K = rubber().bulk_modulus();
  const HyperelasticLaw a(StrainEnergy::law_a, rubber()), b(StrainEnergy::law_b, rubber()),
      c(StrainEnergy::law_c, rubber());
  const auto hydrostatic = [](const HyperelasticLaw& material, double J) {
    return material.complete(std::cbrt(J) * Matrix3d::Identity()).energy;
  };
  const double tiny = 1e-200, huge = 1e12, log = std::log(tiny);
  EXPECT_NEAR(hydrostatic(a, tiny) / (lambda / 2 * log * log), 1.0, 1e-2);
  EXPECT_NEAR(hydrostatic(b, tiny) / (-G * log), 1.0, 1e-2);
  EXPECT_NEAR(hydrostatic(c, tiny) / (K / 2 * log * log), 1.0, 1e-12);
  EXPECT_NEAR(hydrostatic(a, huge) / (1.5 * G * std::pow(huge, 2.0 / 3)), 1.0, 1e-3);
  EXPECT_NEAR(hydrostatic(b, huge) / (lambda / 2 * huge * huge), 1.0, 1e-3);
  EXPECT_NEAR(hydrostatic(c, huge) / (K / 2 * std::pow(std::log(huge), 2)), 1.0, 1e-12);
  EXPECT_NEAR(std::pow(b.volumetric(tiny).value, 2), 1.0, 1e-12);
  const auto mean_stress = [&](double J) {
    return c.cauchy_stress(std::cbrt(J) * Matrix3d::Identity())(0, 0);
  };
  EXPECT_GT(mean_stress(std::numbers::e), mean_stress(0.9 * std::numbers::e));
  EXPECT_GT(mean_stress(std::numbers::e), mean_stress(1.1 * std::numbers::e));
}

TEST(StrainEnergy, InvertedMaterialIsADomainError) {
  Matrix3d mirrored = Matrix3d::Identity(), flat = mirrored, unknown = mirrored;
  mirrored(2, 2) = -1.0;
  flat(2, 2) = 0.0;
  unknown(1, 2) = std::numeric_limits<double>::quiet_NaN();
  for (const StrainEnergy law : all_laws) {
    const HyperelasticLaw material(law, rubber());
    for (const Matrix3d& F : {mirrored, flat, unknown}) {
      EXPECT_THROW(material.pointwise(F), std::domain_error);
      EXPECT_THROW(material.complete(F), std::domain_error);
      EXPECT_THROW(material.cauchy_stress(F), std::domain_error);
      EXPECT_THROW(material.volumetric(F.determinant()), std::domain_error);
    }
  }
}

TEST(StrainEnergy, RefusesRubberWhoseEnergyHasNoBound) {
  meshes::Rubber auxetic = rubber();
  auxetic.youngs_modulus = 27.0;  // nu = -0.036
  for (const StrainEnergy law : {StrainEnergy::law_a, StrainEnergy::law_b}) try {
      const HyperelasticLaw material(law, auxetic);
      ADD_FAILURE() << "lambda < 0 accepted";
    } catch (const meshes::InvalidInput& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find("without bound"), std::string::npos) << text;
      EXPECT_NE(text.find("nu >= 0"), std::string::npos) << text;
    }
  EXPECT_NO_THROW(HyperelasticLaw(StrainEnergy::law_c, auxetic));
  for (const double unit : {1.0, gf_per_cm2, 0.1, 1e3 / 7}) {
    auxetic.shear_modulus = 14.1 * unit;
    auxetic.youngs_modulus = 28.2 * unit;  // nu = 0 but for round-off
    EXPECT_EQ(HyperelasticLaw(StrainEnergy::law_a, auxetic).volumetric_modulus(), 0.0);
  }
  auxetic = rubber();
  auxetic.youngs_modulus = 50.0;  // nu > 1/2
  for (const StrainEnergy law : all_laws)
    EXPECT_THROW(HyperelasticLaw(law, auxetic), meshes::InvalidInput);
}

}  // namespace
