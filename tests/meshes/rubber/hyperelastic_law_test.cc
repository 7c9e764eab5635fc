#include "meshes/rubber/hyperelastic_law.h"
#include "meshes/rubber/law_terms.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "meshes/base/errors.h"
#include "meshes/press/fields.h"
#include "meshes/rubber/stability.h"
#include "tests/expectations.h"

using namespace fingertip;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using meshes::HyperelasticLaw;
using meshes::PointResponse;
using meshes::RubberLaw;
using meshes::StrainEnergy;
using meshes::VolumetricLaw;

namespace {

/// Of each law numbers that are not round, as in vulcanised rubbers.
const std::vector<StrainEnergy> shapes = {
    {},
    {RubberLaw::yeoh, {}, {-0.013, 0.0021}},
    {RubberLaw::mooney_rivlin, {}, {0.27}},
    {RubberLaw::ogden, {}, {0.9, 1.3, 0.02, 4.9, 0.08, -2.1}},
    {RubberLaw::gent, {}, {9.3}},
};

/// Every law with every cost of volume.
std::vector<StrainEnergy> every_law() {
  std::vector<StrainEnergy> all;
  for (const VolumetricLaw volumetric : meshes::values(VolumetricLaw()))
    for (StrainEnergy energy : shapes) {
      energy.volumetric = volumetric;
      all.push_back(energy);
    }
  return all;
}
const std::vector<StrainEnergy> all_laws = every_law();

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

meshes::Rubber rubber(const StrainEnergy& energy) {
  meshes::Rubber result = rubber();
  result.energy = energy;
  return result;
}

HyperelasticLaw law_of(const StrainEnergy& energy) {
  return HyperelasticLaw(rubber(energy));
}

Matrix3d cauchy_stress(const HyperelasticLaw& law, const Matrix3d& F) {
  return law.complete(F).stress * F.transpose() / F.determinant();
}

StrainEnergy neo_hookean(VolumetricLaw volumetric) {
  return {RubberLaw::neo_hookean, volumetric, {}};
}

/// W and dW/dl of the docstring's first table, in principal stretches.
template <typename Number>
Number printed_shape(const StrainEnergy& energy, const Number (&l)[3]) {
  using std::log, std::pow;
  const double G = rubber().shear_modulus;
  const auto& n = energy.shape;
  const Number I1 = l[0] * l[0] + l[1] * l[1] + l[2] * l[2];
  const Number I2 = pow(l[0] * l[1], 2.0) + pow(l[1] * l[2], 2.0) + pow(l[2] * l[0], 2.0);
  switch (energy.law) {
    case RubberLaw::yeoh:
      return G / 2 * (I1 - 3.0) + n[0] * G * pow(I1 - 3.0, 2.0) + n[1] * G * pow(I1 - 3.0, 3.0);
    case RubberLaw::mooney_rivlin: return G / 2 * ((1 - n[0]) * (I1 - 3.0) + n[0] * (I2 - 3.0));
    case RubberLaw::gent: return -G * n[0] / 2 * log(1.0 - (I1 - 3.0) / n[0]);
    case RubberLaw::ogden: {
      Number sum = 0.0;
      for (int i = 0; i < 6; i += 2)
        sum += 2 * n[i] * G / (n[i + 1] * n[i + 1]) *
               (pow(l[0], n[i + 1]) + pow(l[1], n[i + 1]) + pow(l[2], n[i + 1]) - 3.0);
      return sum;
    }
    default: return G / 2 * (I1 - 3.0);
  }
}

/// g and m of the docstring's second table.
double reaction(const StrainEnergy& energy) {
  const double G = rubber().shear_modulus;
  const auto& n = energy.shape;
  if (energy.law == RubberLaw::mooney_rivlin) return G * (1 - n[0]) + 2 * G * n[0];
  if (energy.law != RubberLaw::ogden) return G;
  return 2 * G * (n[0] / n[1] + n[2] / n[3] + n[4] / n[5]);
}
double volumetric_constant(const StrainEnergy& energy) {
  const double G = rubber().shear_modulus, lambda = rubber().lame_lambda();
  if (energy.isochoric()) return rubber().bulk_modulus();
  switch (energy.law) {
    case RubberLaw::yeoh: return lambda - 8 * energy.shape[0] * G;
    case RubberLaw::mooney_rivlin: return lambda - 4 * energy.shape[0] * G / 2;
    case RubberLaw::gent: return lambda - 2 * G / energy.shape[0];
    default: return lambda;
  }
}

/// The energies as the docstring prints them, by singular values.
double printed_energy(const StrainEnergy& energy, const Matrix3d& F) {
  const Vector3d values = F.jacobiSvd().singularValues();
  const double J = F.determinant(), h = energy.logarithmic() ? std::log(J) : J - 1;
  const double scale = energy.isochoric() ? std::cbrt(J) : 1.0;
  const double l[3] = {values[0] / scale, values[1] / scale, values[2] / scale};
  return printed_shape(energy, l) - (energy.isochoric() ? 0.0 : reaction(energy) * std::log(J)) +
         volumetric_constant(energy) / 2 * h * h;
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
  for (const StrainEnergy& law : all_laws)
    for (const Matrix3d& F : random_deformations(20))
      EXPECT_NEAR(law_of(law).complete(F).energy, printed_energy(law, F), 1e-11);
}

TEST(StrainEnergy, StressAndTangentAreDerivatives) {
  for (const StrainEnergy& law : all_laws) {
    const HyperelasticLaw material = law_of(law);
    for (const Matrix3d& F : random_deformations(10)) {
      expect_derivatives([&](const Matrix3d& X) { return material.complete(X); }, F);
      expect_derivatives([&](const Matrix3d& X) { return material.pointwise(X); }, F);
    }
  }
}

TEST(StrainEnergy, FluctuationsHaveTheirDerivatives) {
  const double step = 1e-5;
  for (const StrainEnergy& law : all_laws) {
    const HyperelasticLaw material = law_of(law);
    const auto rest = material.fluctuating(Matrix3d::Identity(), 0.0);
    EXPECT_NEAR(rest.slope, rubber().shear_modulus / 2, 1e-12) << describe(law);
    for (const Matrix3d& F : random_deformations(4)) {
      const double excess = 0.3;
      const auto here = material.fluctuating(F, excess);
      EXPECT_NEAR(here.energy, material.energy(F, excess), 1e-11);
      const auto up = material.fluctuating(F, excess + step),
                 down = material.fluctuating(F, excess - step);
      const double scale = 1e2 + here.tangent.cwiseAbs().maxCoeff();
      EXPECT_NEAR(here.slope, (up.energy - down.energy) / (2 * step), 1e-7 * scale);
      EXPECT_NEAR(here.curvature, (up.slope - down.slope) / (2 * step), 1e-7 * scale);
      EXPECT_LT((here.mixed - (up.stress - down.stress) / (2 * step)).norm(), 1e-7 * scale)
          << describe(law);
      expect_derivatives([&](const Matrix3d& X) { return material.fluctuating(X, excess); }, F);
    }
  }
}

TEST(StrainEnergy, PartsMakeTheWhole) {
  for (const StrainEnergy& law : all_laws) {
    const HyperelasticLaw material = law_of(law);
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
  for (const StrainEnergy& law : all_laws) {
    const HyperelasticLaw material = law_of(law);
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
  for (const StrainEnergy& law : all_laws) {
    const HyperelasticLaw material = law_of(law);
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
  for (const StrainEnergy& law : all_laws) {
    const HyperelasticLaw material = law_of(law);
    for (const Matrix3d& F : random_deformations(10)) {
      const PointResponse response = material.complete(F);
      const double scale = response.tangent.cwiseAbs().maxCoeff();
      EXPECT_LT((response.tangent - response.tangent.transpose()).cwiseAbs().maxCoeff(),
                1e-14 * scale);
      const Matrix3d sigma = cauchy_stress(material, F);
      EXPECT_LT((sigma - sigma.transpose()).norm(), 1e-14 * scale);
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
  const HyperelasticLaw material(paper);
  const double stretches[] = {0.8, 0.9, 1.1, 1.2, 1.5};
  const double expected[] = {-9.931, -4.416, 3.677, 6.838, 14.460};  // gf/cm²
  for (int i = 0; i < 5; ++i)
    EXPECT_NEAR(uniaxial_stress(material, stretches[i]) / gf_per_cm2, expected[i], 6e-4);
}

TEST(StrainEnergy, SmallUniaxialStrainGivesYoungsModulus) {
  for (const StrainEnergy& law : all_laws) {
    const HyperelasticLaw material = law_of(law);
    const double e = 1e-5;
    const double slope =
        (uniaxial_stress(material, 1 + e) - uniaxial_stress(material, 1 - e)) / (2 * e);
    EXPECT_NEAR(slope, rubber().youngs_modulus, 1e-6 * 40);
  }
}

/// Differences of principal Cauchy stresses of a deformation that keeps the volume.
double difference(const StrainEnergy& law, const Vector3d& stretch, int a, int b) {
  const Matrix3d sigma = cauchy_stress(law_of(law), stretch.asDiagonal());
  return sigma(a, a) - sigma(b, b);
}

/// Of a law of I1 and I2 W1 and W2, at I1 - 3 = x.
std::pair<double, double> slopes(const StrainEnergy& law, double x) {
  const double G = rubber().shear_modulus;
  const auto& n = law.shape;
  switch (law.law) {
    case RubberLaw::yeoh: return {G / 2 + 2 * n[0] * G * x + 3 * n[1] * G * x * x, 0.0};
    case RubberLaw::mooney_rivlin: return {G / 2 * (1 - n[0]), G / 2 * n[0]};
    case RubberLaw::gent: return {G / 2 * n[0] / (n[0] - x), 0.0};
    default: return {G / 2, 0.0};
  }
}

/// Textbook formulas of incompressible rubber; the volumetric part adds to a pressure alone.
TEST(StrainEnergy, FiveHomogeneousStates) {
  const double G = rubber().shear_modulus;
  for (const StrainEnergy& law : all_laws) {
    const auto& n = law.shape;
    const auto ogden = [&](double first, double second) {
      double sum = 0.0;
      for (int i = 0; i < 6; i += 2)
        sum += 2 * n[i] * G / n[i + 1] * (std::pow(first, n[i + 1]) - std::pow(second, n[i + 1]));
      return sum;
    };
    for (const double l : {0.7, 0.93, 1.2, 1.6}) {
      const double root = 1 / std::sqrt(l), square = l * l;
      double one, two, planar;
      if (law.law == RubberLaw::ogden) {
        one = ogden(l, root);
        two = ogden(l, 1 / square);
        planar = ogden(l, 1 / l);
      } else {
        const auto [u1, u2] = slopes(law, square + 2 / l - 3);
        const auto [e1, e2] = slopes(law, 2 * square + 1 / (square * square) - 3);
        const auto [p1, p2] = slopes(law, square + 1 + 1 / square - 3);
        one = 2 * (square - 1 / l) * (u1 + u2 / l);
        two = 2 * (square - 1 / (square * square)) * (e1 + e2 * square);
        planar = 2 * (square - 1 / square) * (p1 + p2);
      }
      EXPECT_NEAR(difference(law, {l, root, root}, 0, 1), one, 1e-12 * 40) << describe(law);
      EXPECT_NEAR(difference(law, {l, l, 1 / square}, 0, 2), two, 1e-12 * 40) << describe(law);
      EXPECT_NEAR(difference(law, {l, 1, 1 / l}, 0, 2), planar, 1e-12 * 40) << describe(law);
    }
    const double gamma = 0.7, l = gamma / 2 + std::sqrt(1 + gamma * gamma / 4);
    const auto [s1, s2] = slopes(law, gamma * gamma);
    const double shear =
        law.law == RubberLaw::ogden ? ogden(l, 1 / l) / (l + 1 / l) : 2 * (s1 + s2) * gamma;
    EXPECT_NEAR(cauchy_stress(law_of(law), with(Matrix3d::Identity(), 0, 1, gamma))(0, 1), shear,
                1e-12 * 40);
    for (const double J : {0.8, 1.1}) {
      const double a = std::cbrt(J), m = volumetric_constant(law);
      double mean = (law.logarithmic() ? m * std::log(J) : m * (J - 1) * J) / J;
      if (!law.isochoric()) {  // tau = l dW/dl, here by I1 = 3 a², I2 = 3 a⁴
        const auto [v1, v2] = slopes(law, 3 * a * a - 3);
        const double tau = law.law == RubberLaw::ogden
                               ? ogden(a, 1.0)
                               : 2 * a * a * (v1 + 2 * v2 * a * a) - reaction(law);
        mean += tau / J;
      }
      EXPECT_NEAR(cauchy_stress(law_of(law), a * Matrix3d::Identity())(0, 0), mean, 1e-12 * 100);
    }
  }
}

/// Equal stretches are where formulas of principal axes divide by zero.
TEST(StrainEnergy, PassesEqualStretchesSmoothly) {
  for (const StrainEnergy& law : all_laws) {
    if (law.law != RubberLaw::ogden) continue;
    const Matrix3d Q = random_rotation(3), R = random_rotation(4);
    const auto tangent = [&](double apart) {
      const Vector3d stretch(1.3 + apart, 1.3, 1.3 - 0.5 * apart);
      return law_of(law).complete(Q * stretch.asDiagonal() * R).tangent;
    };
    for (const double apart : {1e-6, 1e-9, 1e-13})
      EXPECT_LT((tangent(apart) - tangent(0.0)).norm(), 2e3 * apart + 1e-9);
  }
}

/// The same with the pressure left out, in every member of the family that a material test sees.
TEST(StrainEnergy, PrincipalResponseIsTheLawOfAnIncompressibleRubber) {
  const double G = rubber().shear_modulus;
  for (const StrainEnergy& law : shapes) {
    const Vector3d stretch(1.4, 0.8, 1 / (1.4 * 0.8));
    const std::array<double, 3> l = {stretch[0], stretch[1], stretch[2]};
    const auto response = meshes::principal_response(law, l);
    EXPECT_NEAR(G * response.energy, printed_shape(law, {l[0], l[1], l[2]}), 1e-12 * G);
    EXPECT_NEAR(G * (response.kirchhoff[0] - response.kirchhoff[1]), difference(law, stretch, 0, 1),
                1e-12 * 40);
    for (std::size_t b = 0; b < 3; ++b) {
      const double step = 1e-5;
      auto up = l, down = l;
      up[b] *= std::exp(step);
      down[b] *= std::exp(-step);
      const auto above = meshes::principal_response(law, up),
                 below = meshes::principal_response(law, down);
      EXPECT_NEAR(response.kirchhoff[b], (above.energy - below.energy) / (2 * step), 1e-8);
      for (std::size_t a = 0; a < 3; ++a)
        EXPECT_NEAR(response.tangent[a][b], (above.kirchhoff[a] - below.kirchhoff[a]) / (2 * step),
                    1e-8);
    }
  }
}

/// With mu > 0 every term is convex in ln l, also where one direction is 1e20 times stiffer than
/// the others.
TEST(StrainEnergy, OgdensLawWithPositiveModuliIsStableHoweverSteep) {
  for (const double alpha : {-20.0, -7.8, 0.5, 12.0})
    EXPECT_FALSE(meshes::first_instability({RubberLaw::ogden, {}, {1.0, alpha}}, 0.1, 10.0))
        << alpha;
}

/// dsigma:d(ln l) = 0 there: differences of Cauchy stresses change in a singular way.
TEST(StrainEnergy, FindsWhereALawStopsBeingStable) {
  for (const StrainEnergy& law : shapes)
    EXPECT_FALSE(meshes::first_instability(law, 0.5, 2.0).has_value()) << describe(law);
  const StrainEnergy soft{RubberLaw::yeoh, {}, {-0.05}};
  const auto at = meshes::first_instability(soft, 0.2, 6.0);
  ASSERT_TRUE(at.has_value());
  const double l = std::log(at->stretch);
  const Vector3d logs = at->test == meshes::SheetTest::uniaxial      ? Vector3d(l, -l / 2, -l / 2)
                        : at->test == meshes::SheetTest::equibiaxial ? Vector3d(l, l, -2 * l)
                                                                     : Vector3d(l, 0, -l);
  const auto stresses = [&](const Vector3d& e) {  // sigma_1 - sigma_3, sigma_2 - sigma_3
    const double W = slopes(soft, e.array().exp().square().sum() - 3).first;
    const Vector3d square = (2 * e).array().exp();
    return Eigen::Vector2d(2 * W * (square[0] - square[2]), 2 * W * (square[1] - square[2]));
  };
  Eigen::Matrix2d change;
  for (int k = 0; k < 2; ++k) {
    Vector3d step = Vector3d::Zero();
    step[k] = 1e-5;
    step[2] = -1e-5;
    change.col(k) = (stresses(logs + step) - stresses(logs - step)) / 2e-5;
  }
  EXPECT_NEAR(change.determinant() / change.squaredNorm(), 0.0, 1e-6);
  const auto violations = meshes::violations(soft);
  ASSERT_EQ(violations.size(), 1u);
  EXPECT_TRUE(says(violations[0].rule, "stable"));
  EXPECT_EQ(violations[0].key, "rubber.yeoh");
}

TEST(StrainEnergy, GrowsAsTheDocstringSays) {
  const double G = rubber().shear_modulus, lambda = rubber().lame_lambda(),
               K = rubber().bulk_modulus();
  const HyperelasticLaw a(rubber(neo_hookean(VolumetricLaw::logarithmic))),
      b(rubber(neo_hookean(VolumetricLaw::full_quadratic))),
      c(rubber(neo_hookean(VolumetricLaw::isochoric_logarithmic)));
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
    return cauchy_stress(c, std::cbrt(J) * Matrix3d::Identity())(0, 0);
  };
  EXPECT_GT(mean_stress(std::numbers::e), mean_stress(0.9 * std::numbers::e));
  EXPECT_GT(mean_stress(std::numbers::e), mean_stress(1.1 * std::numbers::e));
}

TEST(StrainEnergy, InvertedMaterialIsADomainError) {
  Matrix3d mirrored = Matrix3d::Identity(), flat = mirrored, unknown = mirrored;
  mirrored(2, 2) = -1.0;
  flat(2, 2) = 0.0;
  unknown(1, 2) = std::numeric_limits<double>::quiet_NaN();
  for (const StrainEnergy& law : all_laws) {
    const HyperelasticLaw material = law_of(law);
    for (const Matrix3d& F : {mirrored, flat, unknown}) {
      EXPECT_THROW(material.pointwise(F), std::domain_error);
      EXPECT_THROW(material.complete(F), std::domain_error);
      EXPECT_THROW(material.volumetric(F.determinant()), std::domain_error);
    }
  }
}

TEST(StrainEnergy, RefusesRubberWhoseEnergyHasNoBound) {
  meshes::Rubber auxetic = rubber();
  auxetic.youngs_modulus = 27.0;  // nu = -0.036
  for (const VolumetricLaw law : {VolumetricLaw::logarithmic, VolumetricLaw::full_quadratic}) try {
      auxetic.energy.volumetric = law;
      const HyperelasticLaw material(auxetic);
      ADD_FAILURE() << "lambda < 0 accepted";
    } catch (const meshes::InvalidInput& error) {
      const std::string text = error.what();
      EXPECT_TRUE(says(text, {"without bound", "nu >= 0"}));
    }
  auxetic.energy.volumetric = VolumetricLaw::isochoric_logarithmic;
  EXPECT_NO_THROW(HyperelasticLaw{auxetic});
  auxetic.energy = {};
  for (const double unit : {1.0, gf_per_cm2, 0.1, 1e3 / 7}) {
    auxetic.shear_modulus = 14.1 * unit;
    auxetic.youngs_modulus = 28.2 * unit;  // nu = 0 but for round-off
    EXPECT_EQ(HyperelasticLaw(auxetic).volumetric_modulus(), 0.0);
  }
  auxetic = rubber();
  auxetic.youngs_modulus = 50.0;  // nu > 1/2
  for (const StrainEnergy& law : all_laws) {
    auxetic.energy = law;
    EXPECT_THROW_SAYING(HyperelasticLaw{auxetic}, meshes::InvalidInput, "rubber.shear_modulus");
  }
}

TEST(StrainEnergy, RefusesWhatALawCannotBe) {
  const auto refused = [](const StrainEnergy& energy, const char* word) {
    EXPECT_TRUE(refuses<meshes::InvalidInput>([&] { law_of(energy); }, word));
  };
  refused({RubberLaw::linear, {}, {}}, "rubber.law");
  refused({RubberLaw::ogden, {}, {0.5, 2.0, 0.4, 3.0}}, "sum to 1");
  refused({RubberLaw::ogden, {}, {1.0, 0.0}}, "exponents");
  refused({RubberLaw::gent, {}, {-1.0}}, "gent_jm");
  refused({RubberLaw::gent, {}, {std::nan("")}}, "finite");
  refused({RubberLaw::yeoh, VolumetricLaw::logarithmic, {1.0}}, "rubber.volumetric");
  EXPECT_NO_THROW(law_of({RubberLaw::yeoh, VolumetricLaw::quadratic, {1.0}}));
}

TEST(StrainEnergy, AGentLawEndsAtItsLimit) {
  const HyperelasticLaw law = law_of({RubberLaw::gent, {}, {2.0}});
  const Matrix3d F = Vector3d(2.2, 1.0, 1 / 2.2).asDiagonal();
  EXPECT_THROW(law.complete(F), std::domain_error);
  EXPECT_EQ(law.energy(F), std::numeric_limits<double>::infinity());
}

}  // namespace
