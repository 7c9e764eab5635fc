#include "calibration/contact_laws/soft_contact.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace fingertip::calibration::inline contact_laws {

namespace {

/// How far beyond the curve the impedance grows, over its depth.
constexpr double min_width = 1.2, max_width = 8.0;
/// Impedances below are weak in motion, and near 1 MuJoCo's solver is badly conditioned.
constexpr double min_impedance = 0.005, max_impedance = 0.95;
constexpr double min_midpoint = 1e-3, max_power = 6.0;

/// ln of the stiffness, both impedances, midpoint, power, width over the depth.
using Coordinates = std::array<double, 6>;

SoftContact contact_at(const double* x, double depth) {
  return {std::exp(x[0]), x[1], x[2], x[5] * depth, x[3], x[4]};
}

struct RelativeForce {
  double penetration, force, depth;
  bool operator()(const double* x, double* residual) const {
    *residual = contact_at(x, depth).force(penetration) / force - 1.0;
    return true;
  }
};

}  // namespace

double SoftContact::impedance(double penetration) const {
  const double x = std::clamp(penetration / width, 0.0, 1.0);
  const double y = x <= midpoint
                       ? std::pow(x, power) / std::pow(midpoint, power - 1.0)
                       : 1.0 - std::pow(1.0 - x, power) / std::pow(1.0 - midpoint, power - 1.0);
  return dmin + y * (dmax - dmin);
}

double SoftContact::force(double penetration) const {
  if (!(penetration > 0.0)) return 0.0;
  const double d = impedance(penetration);
  return stiffness * penetration * d * d / (dmax * dmax * (1.0 - d));
}

SoftContact fitted_soft_contact(const ForceCurve& curve) {
  check_growth(curve);
  const double depth = curve.indentation.back(), secant = curve.force.back() / depth;
  std::vector<Coordinates> starts;
  for (const double midpoint : {0.1, 0.5, 0.9})
    for (const double power : {1.5, 3.0})
      for (const double dmax : {0.2, 0.8})
        for (const double dmin : {0.2, 0.8})
          starts.push_back(
              {std::log(secant * (1.0 - dmax)), dmin * dmax, dmax, midpoint, power, 2.0});
  double least = std::numeric_limits<double>::infinity();
  SoftContact best;
  for (Coordinates x : starts) {
    const std::array<std::pair<double, double>, 6> bounds = {{{x[0] - 20.0, x[0] + 20.0},
                                                              {min_impedance, max_impedance},
                                                              {min_impedance, max_impedance},
                                                              {min_midpoint, 1.0 - min_midpoint},
                                                              {1.0, max_power},
                                                              {min_width, max_width}}};
    ceres::Problem problem;
    for (std::size_t i = 0; i < curve.force.size(); ++i)
      problem.AddResidualBlock(
          new ceres::NumericDiffCostFunction<RelativeForce, ceres::CENTRAL, 1, 6>(
              new RelativeForce{curve.indentation[i], curve.force[i], depth}),
          nullptr, x.data());
    for (int k = 0; k < 6; ++k) {
      problem.SetParameterLowerBound(x.data(), k, bounds[std::size_t(k)].first);
      problem.SetParameterUpperBound(x.data(), k, bounds[std::size_t(k)].second);
    }
    ceres::Solver::Options options;
    options.max_num_iterations = 500;
    options.function_tolerance = 1e-10;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (summary.final_cost < least) {
      least = summary.final_cost;
      best = contact_at(x.data(), depth);
    }
  }
  return best;
}

}  // namespace fingertip::calibration::inline contact_laws
