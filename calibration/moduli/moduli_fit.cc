#include "calibration/moduli/moduli_fit.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>

#include "meshes/base/dense.h"
#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::calibration::inline moduli {
namespace {

using lattice::ModelKind;
using lattice::SpringConstants;

/// Of the largest residual of a compromise that meets its targets.
constexpr double reached = 1e-9;
/// Share of the residuals that lies along the directions in which they can change, below which
/// their sum of squares is least.
constexpr double stationary = 1e-7;

/// C11 and G = C44 of springs along the lines between particles, which have C12 = C44 (Cauchy).
struct Springs {
  double c11, g;
};

/// Those that meet E_100 and G: C11 solves E (C11 + G) = (C11 - G)(C11 + 2G).
Springs exact_springs(const meshes::Rubber& rubber) {
  const double e = rubber.youngs_modulus, g = rubber.shear_modulus;
  return {0.5 * (e - g + std::sqrt((e - g) * (e - g) + 4.0 * g * (e + 2.0 * g))), g};
}

/// Residuals over their weights by x = ln (C11 - G)/E, ln G/E: all that springs that are not
/// negative can have.
struct Compromise {
  double youngs_modulus, shear_modulus, bulk_modulus, isotropy_weight, bulk_weight;

  template <typename T>
  bool operator()(const T* x, T* residuals) const {
    const T g = youngs_modulus * exp(x[1]), c11 = g + youngs_modulus * exp(x[0]);
    // Along a direction with l²m² + m²n² + n²l² = q.
    const auto modulus = [&](double q) {
      return 1.0 / ((2.0 / 3.0 - 2.0 * q) / (c11 - g) + 1.0 / (3.0 * (c11 + 2.0 * g)) + q / g);
    };
    const T axial = modulus(0.0);
    residuals[0] = axial / youngs_modulus - 1.0;
    residuals[1] = g / shear_modulus - 1.0;
    residuals[2] = isotropy_weight * (modulus(1.0 / 4.0) / axial - 1.0);
    residuals[3] = isotropy_weight * (modulus(1.0 / 3.0) / axial - 1.0);
    residuals[4] = bulk_weight * ((c11 + 2.0 * g) / (3.0 * bulk_modulus) - 1.0);
    return true;
  }
};

using CompromiseCost = ceres::AutoDiffCostFunction<Compromise, 5, 2>;

/// Whether no small change of the springs makes the sum of squares smaller.
bool is_least(const CompromiseCost& cost, const Eigen::Vector2d& x) {
  Eigen::Matrix<double, 5, 1> residuals;
  Eigen::Matrix<double, 5, 2, Eigen::RowMajor> slopes;
  const double* at = x.data();
  double* by = slopes.data();
  cost.Evaluate(&at, residuals.data(), &by);
  const Eigen::VectorXd along = slopes * meshes::least_squares(slopes, residuals);
  return residuals.cwiseAbs().maxCoeff() < reached || along.norm() <= stationary * residuals.norm();
}

Springs compromise(const meshes::Rubber& rubber, const ModuliFitOptions& options, int& iterations) {
  const double e = rubber.youngs_modulus;
  auto* cost = new CompromiseCost(new Compromise{e, rubber.shear_modulus, rubber.bulk_modulus(),
                                                 options.isotropy_weight, options.bulk_weight});
  const Springs start = exact_springs(rubber);
  Eigen::Vector2d x(std::log((start.c11 - start.g) / e), std::log(start.g / e));
  ceres::Problem problem;
  problem.AddResidualBlock(cost, nullptr, x.data());
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = 1000;
  // To round-off rather than to slow progress.
  solver.function_tolerance = 0.0;
  solver.gradient_tolerance = 1e-20;
  solver.parameter_tolerance = 1e-16;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  if (!is_least(*cost, x))
    throw meshes::NotConverged("moduli fit: the search for a compromise ended before its minimum");
  iterations = int(summary.iterations.size());
  const double g = e * std::exp(x(1));
  return {g + e * std::exp(x(0)), g};
}

/// Of all constants with these moduli, which differ by t (4/3, -4/3, 1), those whose weaker one of
/// k1 and k2 is largest, subject to k3 >= 0.
SpringConstants farthest_from_mechanisms(const Springs& springs, double spacing) {
  const double k1 = spacing * (springs.c11 - 2.0 * springs.g), k2 = spacing * springs.g;
  const double t = std::max(0.0, 3.0 / 8.0 * (k2 - k1));
  return {k1 + 4.0 / 3.0 * t, k2 - 4.0 / 3.0 * t, t, 0.0};
}

/// Without weights.
void add_residuals(ModuliFit& fit) {
  const auto add = [&](const char* name, double residual) { fit.residuals[name] = residual; };
  const ElasticModuli& m = fit.achieved;
  const meshes::Rubber& rubber = fit.target;
  const double g = rubber.shear_modulus;
  if (fit.model == ModelKind::hookean) {
    add("C11", (m.c11 - rubber.longitudinal_modulus()) / g);
    add("C12", (m.c12 - rubber.lame_lambda()) / g);
    add("C44", (m.c44 - g) / g);
    return;
  }
  add("E_100", m.youngs_modulus_100 / rubber.youngs_modulus - 1.0);
  add("G", m.shear_modulus / g - 1.0);
  if (fit.isotropy_weight > 0.0) {
    add("E_110/E_100", m.youngs_modulus_110 / m.youngs_modulus_100 - 1.0);
    add("E_111/E_100", m.youngs_modulus_111 / m.youngs_modulus_100 - 1.0);
  }
  if (fit.bulk_weight > 0.0) add("K", m.bulk_modulus / rubber.bulk_modulus() - 1.0);
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
  if (!found.empty()) throw meshes::InvalidInput(found);
}

}  // namespace

ModuliFit fit_moduli(const meshes::Rubber& rubber, const ModuliFitOptions& options) {
  check(rubber, options);
  ModuliFit fit;
  fit.model = options.model;
  fit.spacing = options.spacing;
  fit.target = rubber;
  if (options.model == ModelKind::hookean) {
    fit.constants = lattice::hookean_constants(rubber, options.spacing);
  } else {
    fit.isotropy_weight = options.isotropy_weight;
    fit.bulk_weight = options.bulk_weight;
    fit.constants = farthest_from_mechanisms(
        fit.is_compromise() ? compromise(rubber, options, fit.iterations) : exact_springs(rubber),
        options.spacing);
  }
  fit.achieved = homogenised_moduli(fit.constants, options.spacing);
  add_residuals(fit);
  return fit;
}

}  // namespace fingertip::calibration::inline moduli
