#include "calibration/press_minimum.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "meshes/errors.h"

namespace fingertip::calibration {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// The solver's coordinates: ln(p/size) of what is positive by nature, else p/size.
double to_coordinate(const FreeParameter& free, double p) {
  return varies_by_logarithm(free) ? std::log(p / size_of(free)) : p / size_of(free);
}

VectorXd parameters_at(const VectorXd& x, const PressFitOptions& options) {
  VectorXd p(x.size());
  for (Index i = 0; i < x.size(); ++i) {
    const FreeParameter& free = options.free[std::size_t(i)];
    p(i) = size_of(free) * (varies_by_logarithm(free) ? std::exp(x(i)) : x(i));
  }
  return p;
}

/// Residuals and their derivatives by the coordinates.
Linearisation in_coordinates(PressResiduals& residuals, const VectorXd& x,
                             const PressFitOptions& options) {
  const VectorXd p = parameters_at(x, options);
  Linearisation result = residuals.with_loss(residuals.at(p));
  for (Index i = 0; i < x.size(); ++i) {
    const FreeParameter& free = options.free[std::size_t(i)];
    result.jacobian.col(i) *= varies_by_logarithm(free) ? p(i) : size_of(free);
  }
  return result;
}

/// The problem as Ceres sees it: every coordinate a block, so that each can be held.
class PressCost final : public ceres::CostFunction {
 public:
  PressCost(PressResiduals& residuals, const PressFitOptions& options)
      : residuals_(residuals), options_(options) {
    set_num_residuals(int(residuals.forces() + residuals.priors()));
    mutable_parameter_block_sizes()->assign(options.free.size(), 1);
  }

  bool Evaluate(double const* const* unknowns, double* values, double** jacobians) const override {
    VectorXd x(Index(options_.free.size()));
    for (Index i = 0; i < x.size(); ++i) x(i) = *unknowns[i];
    Linearisation now;
    try {
      now = in_coordinates(residuals_, x, options_);
    } catch (const meshes::InvalidInput&) {
      return false;  // beyond the material's range, E >= 3G say: Ceres shortens its step
    } catch (const meshes::NotConverged&) {
      return false;
    }
    Eigen::Map<VectorXd>(values, num_residuals()) = now.residuals;
    for (Index i = 0; jacobians != nullptr && i < x.size(); ++i)
      if (jacobians[i] != nullptr)
        Eigen::Map<VectorXd>(jacobians[i], num_residuals()) = now.jacobian.col(i);
    return true;
  }

 private:
  PressResiduals& residuals_;
  const PressFitOptions& options_;
};

struct Bounds {
  VectorXd lower, upper;
};

Bounds bounds_of(const PressFitOptions& options) {
  const Index count = Index(options.free.size());
  Bounds bounds{VectorXd(count), VectorXd(count)};
  for (Index i = 0; i < count; ++i) {
    const FreeParameter& free = options.free[std::size_t(i)];
    bounds.lower(i) = to_coordinate(free, lower_bound(free));
    bounds.upper(i) = to_coordinate(free, free.upper);
  }
  return bounds;
}

/// Moves x; returns the number of iterations.
int search(PressResiduals& residuals, const PressFitOptions& options, const Bounds& bounds,
           const std::vector<bool>& held, VectorXd& x) {
  ceres::Problem problem;
  std::vector<double*> blocks;
  for (double& coordinate : x) blocks.push_back(&coordinate);
  problem.AddResidualBlock(new PressCost(residuals, options), nullptr, blocks);
  for (Index i = 0; i < x.size(); ++i) {
    double* block = blocks[std::size_t(i)];
    if (std::isfinite(bounds.lower(i))) problem.SetParameterLowerBound(block, 0, bounds.lower(i));
    if (std::isfinite(bounds.upper(i))) problem.SetParameterUpperBound(block, 0, bounds.upper(i));
    if (held[std::size_t(i)]) problem.SetParameterBlockConstant(block);
  }
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = options.max_iterations;
  // Next to undamped at first, so that one step solves what is linear. A loss that falls by less
  // than its tolerance, which is above what the press is solved to, is known to 1e-5 of a standard
  // error.
  solver.initial_trust_region_radius = 1e12;
  solver.function_tolerance = 1e-10;
  solver.gradient_tolerance = 1e-15;
  solver.parameter_tolerance = 1e-10;
  // A force that jumps, as with stick, ends the search where no step down is left.
  solver.min_trust_region_radius = 1e-10;
  solver.max_num_consecutive_invalid_steps = 20;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  if (summary.termination_type != ceres::CONVERGENCE)
    throw meshes::NotConverged("press fit: no minimum after " +
                               std::to_string(options.max_iterations) +
                               " iterations: " + summary.message);
  return int(summary.iterations.size()) - 1;
}

/// At a bound, with the loss falling beyond it.
std::vector<bool> pushed_against(const Bounds& bounds, const VectorXd& x,
                                 const VectorXd& gradient) {
  std::vector<bool> pushed;
  for (Index i = 0; i < x.size(); ++i)
    pushed.push_back((x(i) <= bounds.lower(i) && gradient(i) > 0.0) ||
                     (x(i) >= bounds.upper(i) && gradient(i) < 0.0));
  return pushed;
}

}  // namespace

bool varies_by_logarithm(const FreeParameter& free) {
  switch (free.parameter) {
    case MaterialParameter::youngs_modulus:
    case MaterialParameter::shear_modulus:
    case MaterialParameter::lame_shear:
    case MaterialParameter::bond:
    case MaterialParameter::contact: return true;
    default: return false;
  }
}

double size_of(const FreeParameter& free) {
  return free.scale > 0.0 ? free.scale : std::abs(free.start);
}

double lower_bound(const FreeParameter& free) {
  const bool may_be_negative =
      free.parameter == MaterialParameter::kappa || free.parameter == MaterialParameter::lambda;
  return may_be_negative ? free.lower : std::max(0.0, free.lower);
}

Minimum minimise(PressResiduals& residuals, const PressFitOptions& options, const VectorXd& start) {
  const Bounds bounds = bounds_of(options);
  VectorXd x(start.size());
  for (Index i = 0; i < x.size(); ++i) x(i) = to_coordinate(options.free[std::size_t(i)], start(i));
  residuals.at(parameters_at(x, options));  // what is wrong at the start is said here

  Minimum minimum;
  std::vector<bool> held(options.free.size(), false);
  for (std::size_t round = 0; round <= 2 * options.free.size(); ++round) {
    minimum.iterations += search(residuals, options, bounds, held, x);
    const Linearisation now = in_coordinates(residuals, x, options);
    minimum.estimates = parameters_at(x, options);
    minimum.loss = 0.5 * now.residuals.squaredNorm();
    const auto pushed = pushed_against(bounds, x, now.jacobian.transpose() * now.residuals);
    if (pushed == held) return minimum;
    held = pushed;
  }
  throw meshes::NotConverged("press fit: which parameters lie at their bounds does not settle");
}

}  // namespace fingertip::calibration
