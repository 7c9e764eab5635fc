/// Stresses of laws in homogeneous tests against formulas written out, and their derivatives.
#include "calibration/material_tests/law_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "meshes/base/errors.h"

using namespace fingertip;
using namespace fingertip::calibration;
using Eigen::VectorXd;
using meshes::RubberLaw;

namespace {

constexpr double kPa = 1e3;

VectorXd vector_of(std::initializer_list<double> values) {
  return VectorXd::Map(values.begin(), Eigen::Index(values.size()));
}

struct Known {
  LawChoice choice;
  VectorXd coefficients;
};
const std::vector<Known> laws = {
    {{RubberLaw::neo_hookean, 1}, vector_of({30 * kPa})},
    {{RubberLaw::mooney_rivlin, 1}, vector_of({12 * kPa, 3 * kPa})},
    {{RubberLaw::gent, 1}, vector_of({30 * kPa, 40.0})},
    {{RubberLaw::yeoh, 3}, vector_of({15 * kPa, -0.2 * kPa, 0.03 * kPa})},
    {{RubberLaw::ogden, 3}, vector_of({18 * kPa, 1.3, 0.4 * kPa, 5.0, 2 * kPa, -2.0})}};
const std::vector<double> stretches = {0.35, 0.6, 0.9, 1.0, 1.2, 2.0, 3.5};

/// dW/dI1 and dW/dI2 by the laws' definitions [Pa].
std::array<double, 2> slopes(const Known& law, double above) {
  const VectorXd& c = law.coefficients;
  switch (law.choice.law) {
    case RubberLaw::mooney_rivlin: return {c(0), c(1)};
    case RubberLaw::gent: return {0.5 * c(0) * c(1) / (c(1) - above), 0.0};
    case RubberLaw::yeoh: return {c(0) + above * (2.0 * c(1) + above * 3.0 * c(2)), 0.0};
    default: return {0.5 * c(0), 0.0};
  }
}

/// Nominal stress as textbooks print it.
double textbook(const Known& law, TestKind kind, double l) {
  const auto sum = [&](double a,
                       double b) {  // of Ogden: sum 2 mu/alpha (l^(a alpha) - l^(b alpha))
    double stress = 0.0;
    for (Eigen::Index i = 0; i < law.coefficients.size(); i += 2) {
      const double mu = law.coefficients(i), alpha = law.coefficients(i + 1);
      stress += 2.0 * mu / alpha * (std::pow(l, a * alpha) - std::pow(l, b * alpha));
    }
    return stress / l;
  };
  const bool ogden = law.choice.law == RubberLaw::ogden;
  switch (kind) {
    case TestKind::uniaxial: {
      if (ogden) return sum(1.0, -0.5);
      const auto [w1, w2] = slopes(law, l * l + 2.0 / l - 3.0);
      return 2.0 * (l - 1.0 / (l * l)) * (w1 + w2 / l);
    }
    case TestKind::equibiaxial: {
      if (ogden) return sum(1.0, -2.0);
      const auto [w1, w2] = slopes(law, 2.0 * l * l + std::pow(l, -4.0) - 3.0);
      return 2.0 * (l - std::pow(l, -5.0)) * (w1 + l * l * w2);
    }
    case TestKind::planar: {
      if (ogden) return sum(1.0, -1.0);
      const auto [w1, w2] = slopes(law, l * l + 1.0 / (l * l) - 2.0);
      return 2.0 * (l - std::pow(l, -3.0)) * (w1 + w2);
    }
    default: return 0.0;
  }
}

TEST(LawModel, AnswersWithTheFormulasOfTextbooks) {
  for (const Known& law : laws)
    for (const TestKind kind : {TestKind::uniaxial, TestKind::equibiaxial, TestKind::planar})
      for (const double stretch : stretches) {
        if (law.choice.law == RubberLaw::gent && kind == TestKind::equibiaxial && stretch < 0.4)
          continue;  // beyond the limit
        const double expected = textbook(law, kind, stretch);
        const SizedLaw sized = sized_law(law.choice, law.coefficients);
        const double nominal = test_stress(sized, kind, StressMeasure::nominal, stretch);
        const double scale = std::abs(expected) + 1.0;
        EXPECT_NEAR(nominal, expected, 1e-12 * scale) << name(law.choice) << ' ' << stretch;
        EXPECT_NEAR(test_stress(sized, kind, StressMeasure::cauchy, stretch), stretch * expected,
                    1e-12 * stretch * scale);
      }
}

TEST(LawModel, SimpleShearIsTwiceTheSlopesTimesTheShear) {
  for (const Known& law : laws) {
    if (law.choice.law == RubberLaw::ogden) continue;
    const SizedLaw sized = sized_law(law.choice, law.coefficients);
    for (const double shear : {0.01, 0.3, 1.0, 2.5}) {
      const auto [w1, w2] = slopes(law, shear * shear);
      EXPECT_NEAR(test_stress(sized, TestKind::simple_shear, StressMeasure::nominal, shear),
                  2.0 * (w1 + w2) * shear, 1e-11 * sized.shear_modulus * shear)
          << name(law.choice);
    }
  }
}

TEST(LawModel, SmallStrainKnowsTheShearModulusAlone) {
  for (const Known& law : laws) {
    const SizedLaw sized = sized_law(law.choice, law.coefficients);
    const double g = sized.shear_modulus, e = 1e-6;
    const auto stress = [&](TestKind kind, double at) {
      return test_stress(sized, kind, StressMeasure::nominal, at) / (g * e);
    };
    EXPECT_NEAR(stress(TestKind::uniaxial, 1.0 + e), 3.0, 1e-4) << name(law.choice);
    EXPECT_NEAR(stress(TestKind::equibiaxial, 1.0 + e), 6.0, 1e-4);
    EXPECT_NEAR(stress(TestKind::planar, 1.0 + e), 4.0, 1e-4);
    EXPECT_NEAR(stress(TestKind::simple_shear, e), 1.0, 1e-4);
    EXPECT_TRUE(meshes::violations(sized.energy).empty()) << name(law.choice);
  }
}

TEST(LawModel, DerivativesAreThoseOfDifferences) {
  for (const Known& law : laws)
    for (const TestKind kind :
         {TestKind::uniaxial, TestKind::equibiaxial, TestKind::planar, TestKind::simple_shear}) {
      MaterialTest test{"t", kind, StressMeasure::nominal, {0.5, 0.8, 1.3, 2.2}, {1, 1, 1, 1}};
      LawModel model(test, {1.0, 1.0, 1.0, 1.0}, law.choice, coefficients(law.choice));
      const CurveSlopes at = model.evaluate(law.coefficients);
      for (Eigen::Index i = 0; i < law.coefficients.size(); ++i) {
        const VectorXd step =
            1e-5 * law.coefficients(i) * VectorXd::Unit(law.coefficients.size(), i);
        const VectorXd slope = (model.evaluate(law.coefficients + step).value -
                                model.evaluate(law.coefficients - step).value) /
                               (2.0 * step(i));
        EXPECT_LE((slope - at.jacobian.col(i)).norm(),
                  1e-8 * slope.norm() + 1e-9 * at.value.norm() / std::abs(law.coefficients(i)))
            << name(law.choice) << ' ' << name(kind) << ' ' << i;
      }
    }
}

TEST(LawModel, ASmallExponentIsThatOfLogarithms) {
  // 2 mu/alpha (l^alpha - 1) -> 2 mu ln l.
  const LawChoice ogden{RubberLaw::ogden, 1};
  MaterialTest test{"t", TestKind::uniaxial, StressMeasure::cauchy, {0.5, 2.0}, {1, 1}};
  LawModel model(test, {1.0, 1.0}, ogden, coefficients(ogden));
  const auto at = model.evaluate(vector_of({1.0, 1e-7}));
  EXPECT_NEAR(at.value(1), 3.0 * std::log(2.0), 1e-6);
  const auto further = model.evaluate(vector_of({1.0, 1e-3}));
  EXPECT_NEAR(at.jacobian(1, 1), (further.value(1) - at.value(1)) / 1e-3, 1e-3);
}

TEST(LawModel, TellsWhatItCannotAnswer) {
  const LawChoice gent{RubberLaw::gent, 1};
  MaterialTest test{"t", TestKind::uniaxial, StressMeasure::nominal, {5.0}, {1}};
  EXPECT_THROW(LawModel(test, {1.0}, gent, coefficients(gent)).evaluate(vector_of({1.0, 10.0})),
               meshes::NotConverged);
  EXPECT_THROW(sized_law({RubberLaw::mooney_rivlin, 1}, vector_of({1.0, -2.0})),
               meshes::InvalidInput);
  EXPECT_FALSE(law_named("yeoh-7"));
  for (const LawChoice& law : known_laws()) EXPECT_EQ(law_named(name(law)), law);
}

}  // namespace
