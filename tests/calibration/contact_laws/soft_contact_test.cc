// The static force of MuJoCo's contact and a ball of hydroelastic pressure.

#include "calibration/contact_laws/soft_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "calibration/contact_laws/pressure_law.h"
#include "meshes/base/errors.h"

using namespace fingertip;
using namespace fingertip::calibration;

namespace {

constexpr double depth = 3e-3;

template <typename Force>
ForceCurve sampled(const Force& force) {
  ForceCurve curve;
  for (int i = 1; i <= 12; ++i) {
    curve.indentation.push_back(depth * i / 12);
    curve.force.push_back(force(curve.indentation.back()));
  }
  return curve;
}

template <typename Law>
double worst(const Law& law, const ForceCurve& curve) {
  double most = 0.0;
  for (std::size_t i = 0; i < curve.force.size(); ++i)
    most = std::max(most, std::abs(law(curve.indentation[i]) / curve.force[i] - 1.0));
  return most;
}

}  // namespace

TEST(SoftContact, ImpedanceGrowsFromTheLeastToTheGreatest) {
  const SoftContact contact{1000.0, 0.1, 0.8, 2e-3, 0.3, 2.5};
  EXPECT_DOUBLE_EQ(contact.impedance(0.0), 0.1);
  EXPECT_DOUBLE_EQ(contact.impedance(2e-3), 0.8);
  EXPECT_DOUBLE_EQ(contact.impedance(5e-3), 0.8);
  // Both powers meet at the midpoint, where y is the midpoint.
  EXPECT_NEAR(contact.impedance(0.6e-3), 0.1 + 0.3 * 0.7, 1e-12);
  EXPECT_NEAR(contact.impedance(0.6e-3 * (1 + 1e-9)), 0.1 + 0.3 * 0.7, 1e-8);
  EXPECT_EQ(contact.force(0.0), 0.0);
  EXPECT_EQ(contact.force(-1e-3), 0.0);
  // At full impedance K r/(1 - dmax).
  EXPECT_NEAR(contact.force(4e-3), 1000.0 * 4e-3 / 0.2, 1e-12);
}

TEST(SoftContact, ItsOwnForcesAreFoundAgain) {
  const SoftContact truth{80.0, 0.1, 0.7, 5e-3, 0.4, 2.0};
  const ForceCurve curve = sampled([&](double r) { return truth.force(r); });
  const SoftContact found = fitted_soft_contact(curve);
  EXPECT_LT(worst([&](double r) { return found.force(r); }, curve), 2e-3);
}

TEST(SoftContact, CarriesHertzAndALayerWithinFivePercent) {
  for (const double exponent : {1.5, 2.0}) {
    const ForceCurve curve = sampled([&](double r) { return 0.3 * std::pow(r / depth, exponent); });
    const SoftContact found = fitted_soft_contact(curve);
    EXPECT_LT(worst([&](double r) { return found.force(r); }, curve), 0.07) << exponent;
    EXPECT_GE(found.width, depth);
    EXPECT_GE(found.power, 1.0);
    EXPECT_LT(found.dmin, 1.0);
  }
}

TEST(SoftContact, CurvesThatDoNotGrowAreRefused) {
  EXPECT_THROW(fitted_soft_contact({{1e-3}, {1.0}}), meshes::InvalidInput);
  EXPECT_THROW(fitted_soft_contact({{1e-3, 2e-3}, {1.0, 0.5}}), meshes::InvalidInput);
  EXPECT_THROW(fitted_hydroelastic_ball({{1e-3, 2e-3}, {1.0, 0.5}}, {}, 0.01),
               meshes::InvalidInput);
}

TEST(HydroelasticBall, OnAPlaneIsTheIntegralInClosedForm) {
  const double R = 0.01;
  const HydroelasticBall ball{1e5, R};
  for (const double d : {0.1e-3, 1e-3, 3e-3}) {
    const double h = R - d;
    const double force = 2.0 * std::numbers::pi * ball.modulus *
                         (0.5 * (R * R - h * h) - (R * R * R - h * h * h) / (3.0 * R));
    EXPECT_NEAR(ball.force({}, d) / force, 1.0, 1e-4) << d;
  }
  EXPECT_EQ(ball.force({}, 0.0), 0.0);
  const ForceCurve curve = sampled([&](double d) { return ball.force({}, d); });
  EXPECT_NEAR(fitted_hydroelastic_ball(curve, {}, R).modulus, ball.modulus, 1e-6 * ball.modulus);
}

TEST(HydroelasticBall, OnABallIsThatOfBothRadii) {
  const double R = 0.01, r = 0.005, d = 0.05e-3;
  const HydroelasticBall ball{1e5, R};
  const meshes::Obstacle small{meshes::ObstacleShape::sphere, r};
  // Shallow: p = E d'/R over a section of area 2π R r/(R + r) d' at every d' < d.
  const double reduced = R * r / (R + r);
  EXPECT_NEAR(ball.force(small, d) / (std::numbers::pi * ball.modulus * reduced / R * d * d), 1.0,
              0.02);
  const meshes::Obstacle large{meshes::ObstacleShape::sphere, 100.0};
  EXPECT_NEAR(ball.force(large, 1e-3) / ball.force({}, 1e-3), 1.0, 1e-3);
  const meshes::Obstacle cylinder{meshes::ObstacleShape::cylinder, r};
  EXPECT_GT(ball.force(cylinder, 1e-3), ball.force(small, 1e-3));
  EXPECT_LT(ball.force(cylinder, 1e-3), ball.force({}, 1e-3));
}
