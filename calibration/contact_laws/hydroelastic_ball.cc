#include "calibration/contact_laws/hydroelastic_ball.h"

#include <cmath>
#include <numbers>

namespace fingertip::calibration::inline contact_laws {

namespace {

constexpr int rings = 200, sectors = 64;  ///< of the quadrature over the ball's section

}  // namespace

double HydroelasticBall::force(const meshes::Obstacle& obstacle, double indentation) const {
  if (!(indentation > 0.0)) return 0.0;
  const double top = radius - indentation;  // of the obstacle, over the centre
  const double reach =
      std::sqrt(std::max(radius * radius - std::max(top, 0.0) * std::max(top, 0.0), 0.0));
  double sum = 0.0;
  for (int ring = 0; ring < rings; ++ring) {
    const double rho = reach * (ring + 0.5) / rings;
    double mean = 0.0;
    for (int sector = 0; sector < sectors; ++sector) {
      const double angle = 2.0 * std::numbers::pi * (sector + 0.5) / sectors;
      const meshes::Vector3 place(rho * std::cos(angle), rho * std::sin(angle), 0.0);
      const double z = top - meshes::height(obstacle, place);
      mean += std::max(1.0 - std::hypot(rho, z) / radius, 0.0) / sectors;
    }
    sum += mean * 2.0 * std::numbers::pi * rho * reach / rings;
  }
  return modulus * sum;
}

HydroelasticBall fitted_hydroelastic_ball(const ForceCurve& curve, const meshes::Obstacle& obstacle,
                                          double radius) {
  check_growth(curve);
  HydroelasticBall ball{1.0, radius};
  std::vector<double> forces;
  for (const double at : curve.indentation) forces.push_back(ball.force(obstacle, at));
  ball.modulus = fitted_factor(forces, curve);
  return ball;
}

}  // namespace fingertip::calibration::inline contact_laws
