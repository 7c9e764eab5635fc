#include "calibration/statistics/curve_minimum.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>
#include <tuple>
#include <vector>

#include "calibration/statistics/fit_coordinates.h"
#include "meshes/base/dense.h"
#include "meshes/base/errors.h"

namespace fingertip::calibration::inline statistics {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Where a search is: what it seeks and in which coordinates, with their bounds.
struct Problem {
  Problem(CurveResiduals& r, const CurveFitOptions& o)
      : residuals(r),
        options(o),
        coordinates(o),
        lower(coordinates.lower()),
        upper(coordinates.upper()) {}

  /// Residuals and their derivatives by the coordinates.
  Linearisation at(const VectorXd& x) const {
    const VectorXd p = coordinates.parameters(x);
    Linearisation result = residuals.with_loss(residuals.at(p));
    result.jacobian = result.jacobian * coordinates.slopes(p);
    return result;
  }

  /// None where a model refuses or finds no answer.
  std::optional<Linearisation> try_at(const VectorXd& x) const {
    try {
      return at(x);
    } catch (const meshes::InvalidInput&) {
      return std::nullopt;  // beyond the material's range, E >= 3G say
    } catch (const meshes::NotConverged&) {
      return std::nullopt;
    }
  }

  CurveResiduals& residuals;
  const CurveFitOptions& options;
  const FitCoordinates coordinates;
  const VectorXd lower, upper;
};

double loss_of(const Linearisation& at) {
  return 0.5 * at.residuals.squaredNorm();
}

/// The problem as Ceres sees it: every coordinate a block, so that each can be held.
class CurveCost final : public ceres::CostFunction {
 public:
  CurveCost(const Problem& problem, std::exception_ptr& error) : problem_(problem), error_(error) {
    set_num_residuals(int(problem.residuals.values() + problem.residuals.priors()));
    mutable_parameter_block_sizes()->assign(problem.options.free.size(), 1);
  }

  /// A point without an answer makes Ceres shorten its step. Other errors must not pass through
  /// Ceres: they are kept, and nothing is evaluated any more.
  bool Evaluate(double const* const* unknowns, double* values, double** jacobians) const override {
    if (error_) return false;
    VectorXd x(problem_.lower.size());
    for (Index i = 0; i < x.size(); ++i) x(i) = *unknowns[i];
    std::optional<Linearisation> now;
    try {
      now = problem_.try_at(x);
    } catch (...) {
      error_ = std::current_exception();
    }
    if (!now) return false;
    Eigen::Map<VectorXd>(values, num_residuals()) = now->residuals;
    for (Index i = 0; jacobians != nullptr && i < x.size(); ++i)
      if (jacobians[i] != nullptr)
        Eigen::Map<VectorXd>(jacobians[i], num_residuals()) = now->jacobian.col(i);
    return true;
  }

 private:
  const Problem& problem_;
  std::exception_ptr& error_;
};

/// At a bound, with the loss falling beyond it.
std::vector<bool> pushed_against(const Problem& problem, const VectorXd& x) {
  const Linearisation now = problem.at(x);
  const VectorXd gradient = now.jacobian.transpose() * now.residuals;
  std::vector<bool> pushed;
  for (Index i = 0; i < x.size(); ++i)
    pushed.push_back((x(i) <= problem.lower(i) && gradient(i) > 0.0) ||
                     (x(i) >= problem.upper(i) && gradient(i) < 0.0));
  return pushed;
}

/// Ends the search where the loss falls by no more than that of a thousandth of a standard error,
/// where it is round-off, and where a coordinate is pushed against a bound: Ceres would creep along
/// it, while the search that holds it does not.
class EnoughFound final : public ceres::IterationCallback {
 public:
  EnoughFound(const Problem& problem, const std::vector<bool>& held, const VectorXd& x,
              std::exception_ptr& error)
      : problem_(problem), held_(held), x_(x), error_(error) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& now) override {
    if (error_) return ceres::SOLVER_ABORT;
    try {
      return judged(now);
    } catch (...) {
      error_ = std::current_exception();  // must not pass through Ceres
      return ceres::SOLVER_ABORT;
    }
  }

 private:
  ceres::CallbackReturnType judged(const ceres::IterationSummary& now) const {
    const CurveResiduals& residuals = problem_.residuals;
    const bool down = now.step_is_successful && now.iteration > 0;
    const bool little =
        down && now.cost_change <= std::max(1e-6, std::pow(problem_.options.tolerance, 2)) *
                                       residuals.loss_of_standard_error(now.cost);
    return little || now.cost <= residuals.noise() || (down && meets_bound())
               ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
               : ceres::SOLVER_CONTINUE;
  }

  bool meets_bound() const {
    const auto pushed = pushed_against(problem_, x_);
    for (std::size_t i = 0; i < pushed.size(); ++i)
      if (pushed[i] && !held_[i]) return true;
    return false;
  }

  const Problem& problem_;
  const std::vector<bool>& held_;
  const VectorXd& x_;
  std::exception_ptr& error_;
};

ceres::Solver::Options solver_options(const CurveFitOptions& options) {
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = options.max_iterations;
  // Next to undamped at first, so that one step solves what is linear.
  solver.initial_trust_region_radius = 1e12;
  solver.function_tolerance = 1e-8;
  solver.gradient_tolerance = 1e-15;
  // Relative to the coordinates; a standard error is rarely below a hundredth of them.
  solver.parameter_tolerance = std::max(1e-10, 0.01 * options.tolerance);
  // A model that jumps, as stick does, ends the search where no step down is left.
  solver.min_trust_region_radius = 1e-10;
  solver.max_num_consecutive_invalid_steps = 20;
  solver.logging_type = ceres::SILENT;
  return solver;
}

struct Walk {
  int iterations = 0;
  bool converged = false;
};

/// Moves x by Levenberg and Marquardt's method.
Walk search(const Problem& sought, const std::vector<bool>& held, VectorXd& x) {
  std::exception_ptr error;
  ceres::Problem problem;
  std::vector<double*> blocks;
  for (double& coordinate : x) blocks.push_back(&coordinate);
  problem.AddResidualBlock(new CurveCost(sought, error), nullptr, blocks);
  for (Index i = 0; i < x.size(); ++i) {
    double* block = blocks[std::size_t(i)];
    if (std::isfinite(sought.lower(i))) problem.SetParameterLowerBound(block, 0, sought.lower(i));
    if (std::isfinite(sought.upper(i))) problem.SetParameterUpperBound(block, 0, sought.upper(i));
    if (held[std::size_t(i)]) problem.SetParameterBlockConstant(block);
  }
  EnoughFound enough(sought, held, x, error);
  ceres::Solver::Options solver = solver_options(sought.options);
  solver.callbacks.push_back(&enough);
  solver.update_state_every_iteration = true;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  if (error) std::rethrow_exception(error);
  return {int(summary.iterations.size()) - 1, summary.termination_type == ceres::CONVERGENCE ||
                                                  summary.termination_type == ceres::USER_SUCCESS};
}

/// The Gauss–Newton step of the coordinates that are not held, and by how much it lowers the
/// linearised loss. A coordinate that would leave its bounds goes to the bound, and the others to
/// where that is best. What the residuals do not see stays.
struct GaussNewton {
  GaussNewton(const Problem& problem, const Linearisation& at, const VectorXd& x,
              std::vector<bool> held)
      : end(x) {
    for (bool inside = false; !inside;) {
      Eigen::MatrixXd seen = at.jacobian;
      for (Index i = 0; i < x.size(); ++i)
        if (held[std::size_t(i)]) seen.col(i).setZero();
      VectorXd rest = VectorXd::Zero(x.size());
      for (Index i = 0; i < x.size(); ++i)
        if (held[std::size_t(i)]) rest(i) = end(i) - x(i);
      const VectorXd step =
          -meshes::shortest_least_squares(seen, at.residuals + at.jacobian * rest, 1e-12);
      inside = true;
      for (Index i = 0; i < x.size(); ++i) {
        if (held[std::size_t(i)]) continue;
        end(i) = std::clamp(x(i) + step(i), problem.lower(i), problem.upper(i));
        if (end(i) != x(i) + step(i)) held[std::size_t(i)] = true, inside = false;
      }
    }
    promise = loss_of(at) - 0.5 * (at.residuals + at.jacobian * (end - x)).squaredNorm();
  }

  VectorXd end;
  double promise = 0.0;
};

/// Gauss–Newton steps as long as they keep what they promise: next to a minimum there is nothing
/// faster or more exact.
Walk polish(const Problem& problem, const std::vector<bool>& held, VectorXd& x) {
  const CurveResiduals& residuals = problem.residuals;
  Linearisation at = problem.at(x);
  GaussNewton step(problem, at, x, held);
  Walk walk;
  while (true) {
    const double unit = residuals.loss_of_standard_error(loss_of(at));
    const double enough = std::pow(problem.options.tolerance, 2) * unit;
    walk.converged = step.promise <= enough || loss_of(at) <= residuals.noise();
    if (walk.converged || walk.iterations == problem.options.max_iterations) return walk;
    const auto next = problem.try_at(step.end);
    if (!next) return walk;
    const GaussNewton after(problem, *next, step.end, held);
    // Close to the minimum the loss is flatter than its round-off; slopes still tell the way.
    const bool closer = step.promise < 1e-6 * unit && after.promise < 0.25 * step.promise;
    if (!closer && loss_of(*next) > loss_of(at) - 0.1 * step.promise) return walk;
    x = step.end;
    at = *next;
    step = after;
    ++walk.iterations;
  }
}

/// Where Gauss–Newton steps alone do not arrive, Levenberg and Marquardt's do, and the last of the
/// way again is theirs.
Walk descend(const Problem& problem, const std::vector<bool>& held, VectorXd& x) {
  const Walk first = polish(problem, held, x);
  if (first.converged) return first;
  const Walk second = search(problem, held, x);
  const Walk third = polish(problem, held, x);
  return {first.iterations + second.iterations + third.iterations,
          second.converged || third.converged};
}

/// From `start`, adding to `minimum` as it goes. Whether a minimum was found.
bool seek(const Problem& problem, VectorXd x, Minimum& minimum) {
  std::vector<bool> held(problem.options.free.size(), false);
  // More often, the set of parameters at their bounds does not converge.
  for (std::size_t round = 0; round <= 2 * held.size(); ++round) {
    const Walk walk = descend(problem, held, x);
    minimum.iterations += walk.iterations;
    if (!walk.converged) return false;
    minimum.estimates = problem.coordinates.parameters(x);
    minimum.loss = loss_of(problem.at(x));
    const auto pushed = pushed_against(problem, x);
    if (pushed == held) return true;
    held = pushed;
  }
  return false;
}

}  // namespace

Minimum minimise(CurveResiduals& residuals, const CurveFitOptions& options, const VectorXd& start) {
  residuals.forget_least();
  residuals.at(start);  // what is wrong at the start is said here
  Minimum minimum;
  minimum.converged = false;
  try {
    const Problem problem(residuals, options);
    minimum.converged = seek(problem, problem.coordinates.from(start), minimum);
  } catch (const EvaluationsSpent&) {
  }
  if (!minimum.converged) std::tie(minimum.estimates, minimum.loss) = residuals.least();
  return minimum;
}

}  // namespace fingertip::calibration::inline statistics
