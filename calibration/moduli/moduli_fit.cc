#include "calibration/moduli/moduli_fit.h"

#include <ceres/ceres.h>

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "calibration/moduli/cube_test.h"
#include "lattice/statics/cube.h"
#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::calibration::inline moduli {
namespace {

using lattice::ModelKind;
using lattice::SpringConstants;

/// Targets count as reached below this residual; round-off leaves about 1e-13.
constexpr double reached = 1e-9;
/// Share of the residuals that lies along the directions in which they can change, below which
/// their sum of squares is least.
constexpr double stationary = 1e-7;

const Eigen::Vector3d face_diagonal(1.0, 1.0, 0.0), body_diagonal(1.0, 1.0, 1.0);

/// Residuals and Jacobian of the virtual tests as functions of x = (k1, k2, k3)/(E a) and, for
/// hookean, kappa/E: the scaling that makes every unknown of order one. A compromise may end far
/// from the targets, near k1 = k2 = 0, where moduli have no derivatives by the springs; it is
/// sought in x = ln (C11 - C44)/E, ln C44/E, all of which non-negative springs can have.
class ModuliProblem {
 public:
  ModuliProblem(const meshes::Rubber& rubber, const ModuliFitOptions& options)
      : model_(options.model), rubber_(rubber), spacing_(options.spacing) {
    if (model_ == ModelKind::hookean) {
      names_ = {"C11", "C12", "C44"};
      weights_ = {1.0, 1.0, 1.0};
      return;
    }
    names_ = {"E_100", "G"};
    weights_ = {1.0, 1.0};
    isotropy_ = options.isotropy_weight > 0.0;
    bulk_ = options.bulk_weight > 0.0;
    if (isotropy_) {
      names_.insert(names_.end(), {"E_110/E_100", "E_111/E_100"});
      weights_.insert(weights_.end(), 2, options.isotropy_weight);
    }
    if (bulk_) {
      names_.emplace_back("K");
      weights_.push_back(options.bulk_weight);
    }
  }

  int unknowns() const { return is_compromise() ? 2 : constants_varied(); }
  int tests() const { return int(names_.size()); }
  bool is_compromise() const { return isotropy_ || bulk_; }
  const std::vector<std::string>& names() const { return names_; }
  Eigen::Map<const Eigen::VectorXd> weights() const {
    return Eigen::VectorXd::Map(weights_.data(), tests());
  }

  Eigen::Vector4d scale() const {
    const double spring = rubber_.youngs_modulus * spacing_;
    return {spring, spring, spring, rubber_.youngs_modulus};
  }

  SpringConstants constants(const Eigen::VectorXd& x) const {
    const Eigen::Vector4d s = scale();
    if (is_compromise()) return {std::exp(x(0)) * s(0), 0.0, 0.75 * std::exp(x(1)) * s(2), 0.0};
    return {x(0) * s(0), x(1) * s(1), x(2) * s(2), unknowns() == 4 ? x(3) * s(3) : 0.0};
  }

  Eigen::VectorXd residuals(const SpringConstants& constants) const {
    const ElasticModuli m = homogenised_moduli(constants, spacing_);
    const double g = rubber_.shear_modulus;
    if (model_ == ModelKind::hookean)
      return Eigen::Vector3d(m.c11 - rubber_.longitudinal_modulus(), m.c12 - rubber_.lame_lambda(),
                             m.c44 - g) /
             g;
    Eigen::VectorXd found(tests());
    found.head<2>() << m.youngs_modulus_100 / rubber_.youngs_modulus - 1.0,
        m.shear_modulus / g - 1.0;
    if (isotropy_)
      found.segment<2>(2) << m.youngs_modulus_110 / m.youngs_modulus_100 - 1.0,
          m.youngs_modulus_111 / m.youngs_modulus_100 - 1.0;
    if (bulk_) found(tests() - 1) = m.bulk_modulus / rubber_.bulk_modulus() - 1.0;
    return found;
  }

  /// d(residuals)/dx.
  Eigen::MatrixXd jacobian(const SpringConstants& constants) const {
    if (!is_compromise()) return by_constants(constants);
    const ElasticModuli m = homogenised_moduli(constants, spacing_);
    Eigen::Matrix<double, 3, 2> by_logarithms;
    by_logarithms << m.c11 - m.c44, m.c44, 0.0, m.c44, 0.0, m.c44;
    return central_slopes(constants) * by_logarithms;
  }

  /// d(residuals)/d(k1, k2, k3 and, for hookean, kappa) times their scales.
  Eigen::MatrixXd by_constants(const SpringConstants& constants) const {
    const Eigen::MatrixXd by_stiffness =
        model_ == ModelKind::hookean
            ? Eigen::MatrixXd(Eigen::Matrix3d::Identity() / rubber_.shear_modulus)
            : central_slopes(constants);
    return (by_stiffness * stiffness_jacobian(spacing_) * scale().asDiagonal())
        .leftCols(constants_varied());
  }

 private:
  int constants_varied() const { return model_ == ModelKind::hookean ? 4 : 3; }

  /// d(residuals)/d(C11, C12, C44) [1/Pa].
  Eigen::MatrixXd central_slopes(const SpringConstants& constants) const {
    const ElasticModuli m = homogenised_moduli(constants, spacing_);
    const double e = m.youngs_modulus_100;
    const Eigen::RowVector3d axis = youngs_modulus_slopes(m, Eigen::Vector3d::UnitX());
    Eigen::MatrixXd rows(tests(), 3);
    rows.row(0) = axis / rubber_.youngs_modulus;
    rows.row(1) << 0.0, 0.0, 1.0 / rubber_.shear_modulus;
    if (isotropy_) {
      rows.row(2) = (youngs_modulus_slopes(m, face_diagonal) - m.youngs_modulus_110 / e * axis) / e;
      rows.row(3) = (youngs_modulus_slopes(m, body_diagonal) - m.youngs_modulus_111 / e * axis) / e;
    }
    if (bulk_)
      rows.row(tests() - 1) << Eigen::RowVector3d(1.0, 2.0, 0.0) / (3.0 * rubber_.bulk_modulus());
    return rows;
  }

  ModelKind model_;
  meshes::Rubber rubber_;
  double spacing_;
  bool isotropy_ = false, bulk_ = false;
  std::vector<std::string> names_;
  std::vector<double> weights_;
};

/// The problem as Ceres sees it: one block of unknowns, one block of residuals.
class ModuliCost final : public ceres::CostFunction {
 public:
  explicit ModuliCost(const ModuliProblem& problem) : problem_(problem) {
    set_num_residuals(problem.tests());
    mutable_parameter_block_sizes()->push_back(problem.unknowns());
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Eigen::VectorXd> x(parameters[0], problem_.unknowns());
    const SpringConstants constants = problem_.constants(x);
    Eigen::Map<Eigen::VectorXd>(residuals, problem_.tests()) =
        problem_.weights().cwiseProduct(problem_.residuals(constants));
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      Eigen::Map<RowMajor>(jacobians[0], problem_.tests(), problem_.unknowns()) =
          problem_.weights().asDiagonal() * problem_.jacobian(constants);
    }
    // All springs zero has no moduli; Ceres then shortens its step.
    return Eigen::Map<Eigen::VectorXd>(residuals, problem_.tests()).allFinite();
  }

 private:
  ModuliProblem problem_;
};

/// Moves along the direction that changes no modulus, (k1, k2, k3) += t (4/3, -4/3, 1), to the
/// member of the family whose weaker one of k1 and k2 is largest, subject to k3 >= 0.
SpringConstants farthest_from_mechanisms(const SpringConstants& c) {
  double t = std::max(-c.k3, 3.0 / 8.0 * (c.k2 - c.k1));
  // hookean has k1 = k2 exactly at k3 = 0; round-off must not leave a trace of body diagonals.
  if (c.k3 + t < 1e-9 * (c.k1 + c.k2)) t = -c.k3;
  return {c.k1 + 4.0 / 3.0 * t, c.k2 - 4.0 / 3.0 * t, c.k3 + t, c.kappa};
}

struct Solution {
  SpringConstants constants;
  double error = std::numeric_limits<double>::infinity();  ///< largest weighted residual
  double loss = std::numeric_limits<double>::infinity();   ///< sum of their squares
  int iterations = 0;
};

Solution solve_from(const ModuliProblem& problem, Eigen::VectorXd x) {
  ceres::Problem least_squares;
  least_squares.AddResidualBlock(new ModuliCost(problem), nullptr, x.data());
  // A spring must not push back where it should pull; kappa may be negative, its limit K > 0 is
  // met by meeting the targets.
  for (int i = 0; i < 3 && !problem.is_compromise(); ++i)
    least_squares.SetParameterLowerBound(x.data(), i, 0.0);

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = problem.is_compromise() ? 1000 : 200;
  // To round-off rather than to slow progress: targets that can be met are met exactly.
  options.function_tolerance = 0.0;
  options.gradient_tolerance = 1e-20;
  options.parameter_tolerance = 1e-16;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &least_squares, &summary);

  Solution solution;
  if (!summary.IsSolutionUsable()) return solution;
  solution.constants = farthest_from_mechanisms(problem.constants(x));
  const Eigen::VectorXd weighted =
      problem.weights().cwiseProduct(problem.residuals(solution.constants));
  solution.error = weighted.cwiseAbs().maxCoeff();
  solution.loss = weighted.squaredNorm();
  solution.iterations = int(summary.iterations.size());
  return solution;
}

std::vector<Solution> solve_from_random_starts(const ModuliProblem& problem, int starts,
                                               unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> of_order_one(0.05, 3.0);
  std::vector<Solution> solutions;
  for (int start = 0; start < starts; ++start) {
    Eigen::VectorXd x(problem.unknowns());
    for (double& value : x) value = of_order_one(generator);
    if (problem.is_compromise()) x = x.array().log().matrix().eval();
    solutions.push_back(solve_from(problem, x));
  }
  return solutions;
}

/// Whether no small change of the springs makes the loss smaller.
bool is_least(const ModuliProblem& problem, const SpringConstants& c) {
  const Eigen::VectorXd residuals = problem.weights().cwiseProduct(problem.residuals(c));
  const Eigen::MatrixXd jacobian = problem.weights().asDiagonal() * problem.jacobian(c);
  const Eigen::VectorXd along = jacobian * jacobian.colPivHouseholderQr().solve(residuals);
  return along.norm() <= stationary * residuals.norm();
}

/// Right singular vectors of the Jacobian that no test sees, the first nonzero component positive.
std::vector<Eigen::Vector4d> null_directions(const Eigen::MatrixXd& jacobian) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian, Eigen::ComputeFullV);
  const Eigen::VectorXd& values = svd.singularValues();
  std::vector<Eigen::Vector4d> directions;
  for (Eigen::Index i = 0; i < jacobian.cols(); ++i) {
    if (i < values.size() && values(i) >= 1e-8 * values(0)) continue;
    Eigen::Vector4d direction = Eigen::Vector4d::Zero();
    direction.head(jacobian.cols()) = svd.matrixV().col(i);
    direction = (direction.array().abs() > 1e-12).select(direction, 0.0);  // round-off
    Eigen::Index leading = 0;
    while (direction(leading) == 0.0) ++leading;
    directions.push_back(direction * (direction(leading) < 0.0 ? -1.0 : 1.0));
  }
  return directions;
}

int count_agreeing(const std::vector<Solution>& solutions, const Solution& best,
                   const Eigen::Vector4d& scale) {
  const auto scaled = [&](const SpringConstants& c) {
    return Eigen::Vector4d(c.k1, c.k2, c.k3, c.kappa).cwiseQuotient(scale).eval();
  };
  const Eigen::Vector4d reference = scaled(best.constants);
  const double tolerance = 1e-6 * reference.norm();
  return int(std::count_if(solutions.begin(), solutions.end(), [&](const Solution& s) {
    return (scaled(s.constants) - reference).norm() <= tolerance;
  }));
}

void check(const meshes::Rubber& rubber, const ModuliFitOptions& options) {
  std::vector<meshes::Violation> found = rubber.violations();
  if (rubber.youngs_modulus > 0.0 && rubber.shear_modulus > 0.0)
    for (meshes::Violation& violation : found)
      if (violation.key == "rubber.shear_modulus")
        violation.rule +=
            "; a body with K < 0 releases energy when it swells or shrinks, so no lattice and no "
            "continuum rests in that state";
  if (options.model == ModelKind::published)
    found.push_back({"lattice.model", std::string(lattice::name(options.model)),
                     "the published model has a rule for its constants, k = E/l0, not a fit",
                     "calibrate central or hookean"});
  if (options.model == ModelKind::network)
    found.push_back({"lattice.model", std::string(lattice::name(options.model)),
                     "the network takes G and lambda from the rubber; nothing is left to fit",
                     "calibrate central or hookean"});
  if (!std::isfinite(options.spacing) || options.spacing <= 0.0)
    found.push_back({"lattice.spacing", meshes::to_text(options.spacing) + " m",
                     "the spacing must be finite and positive", "give the lattice spacing"});
  for (const auto& [key, weight] :
       {std::pair{"calibration.isotropy_weight", options.isotropy_weight},
        {"calibration.bulk_weight", options.bulk_weight}})
    if (!std::isfinite(weight) || weight < 0.0)
      found.push_back({key, meshes::to_text(weight), "a weight must be finite and not negative",
                       "give 0 to meet E_100 and G exactly, about 1 for a compromise"});
  if (options.starts < 1)
    found.push_back({"calibration.starts", std::to_string(options.starts),
                     "a fit needs at least one start", "give 1 or more"});
  if (!found.empty()) throw meshes::InvalidInput(found);
}

}  // namespace

ModuliFit fit_moduli(const meshes::Rubber& rubber, const ModuliFitOptions& options) {
  check(rubber, options);
  const ModuliProblem problem(rubber, options);
  const std::vector<Solution> solutions =
      solve_from_random_starts(problem, options.starts, options.seed);
  const Solution best = *std::ranges::min_element(solutions, {}, &Solution::loss);
  const bool met = best.error < reached;
  if (!met && !(problem.is_compromise() && is_least(problem, best.constants)))
    throw meshes::NotConverged(
        "moduli fit: none of " + std::to_string(options.starts) + " random starts reached " +
        (problem.is_compromise() ? "a minimum" : "the targets to 1e-9") + "; the best is off by " +
        meshes::to_text(best.error) + "; take more starts (calibration.starts)");

  ModuliFit fit;
  fit.model = options.model;
  fit.spacing = options.spacing;
  fit.target = rubber;
  fit.constants = best.constants;
  if (options.model == ModelKind::central) {
    fit.isotropy_weight = options.isotropy_weight;
    fit.bulk_weight = options.bulk_weight;
  }
  fit.achieved = homogenised_moduli(best.constants, options.spacing);
  fit.residuals = problem.residuals(best.constants);
  fit.residual_names = problem.names();
  fit.unidentifiable = null_directions(problem.by_constants(best.constants));
  fit.converged = true;
  fit.iterations = best.iterations;
  fit.starts = options.starts;
  fit.starts_agreeing = count_agreeing(solutions, best, problem.scale());
  fit.cell_mechanisms =
      count_mechanisms(lattice::cube_lattice(fit.model, fit.constants, fit.spacing, 1));
  return fit;
}

}  // namespace fingertip::calibration::inline moduli
