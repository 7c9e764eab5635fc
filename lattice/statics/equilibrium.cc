#include "lattice/statics/equilibrium.h"

#include <Eigen/CholmodSupport>
#include <algorithm>
#include <cmath>
#include <vector>

#include "lattice/statics/factor_memory.h"

namespace fingertip::lattice::inline statics {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr int max_iterations = 100;
/// Gradients that cost as much as a factorisation, from 1000 to 24 000 unknowns (MEASUREMENTS).
constexpr int factor_cost = 50;
constexpr int max_response_gradients = 30;
constexpr int max_halvings = 20;
constexpr int max_shifts = 6;
constexpr double first_shift = 1e-3;  // of the mean stiffness
/// Accuracy of a Newton step; the next one corrects what it leaves.
constexpr double step_accuracy = 1e-3;
/// Of the residual of a response, over its force.
constexpr double response_accuracy = 1e-12;
/// More than a fresh factor takes.
constexpr int fewest_gradients = 5;
/// Of displacements, over the body's size.
constexpr double round_off = 1e-15;
/// Share of the decrease promised by the slope that a step must bring (Armijo).
constexpr double sufficient_decrease = 1e-4;

}  // namespace

struct EquilibriumSolver::Implementation {
  explicit Implementation(const ElasticSystem& elastic_system);

  double evaluate(const StaticContact& contact, const VectorXd& displacement, Tangent* tangent);
  double energy(const StaticContact& contact, const VectorXd& displacement) const {
    return system.energy(displacement) + contact.energy(displacement);
  }
  void hold_fixed();
  double round_off_force() const;
  double round_off_energy(double energy) const;
  bool find_step(VectorXd& step);
  bool factorise();
  bool iterate(VectorXd& step);
  bool factor_is_stale() const { return last_gradients * steps > factor_cost + gradients; }
  bool search(const StaticContact& contact, const VectorXd& step, VectorXd& displacement);
  bool iterate(const MatrixXd& forces, MatrixXd& responses) const;

  const ElasticSystem& system;
  Tangent tangent;
  VectorXd force;
  std::vector<Eigen::Index> fixed_entries, fixed_diagonal;  ///< of the tangent's values
  Eigen::CholmodSupernodalLLT<Tangent, Eigen::Lower> factor;
  bool factorised = false;
  /// Since the factor was made: Newton steps by it, their gradients, those of the last.
  int steps = 0, gradients = 0, last_gradients = 0;
  double extent = 0.0;  ///< largest coordinate of a particle [m]
  Effort effort;
};

EquilibriumSolver::Implementation::Implementation(const ElasticSystem& elastic_system)
    : system(elastic_system), tangent(system.empty_tangent()) {
  factor.cholmod().print = 0;
  factor.analyzePattern(tangent);
  require_memory(factor.cholmod(), tangent.rows());
  for (const auto& rest : system.body().rest) extent = std::max(extent, rest.cwiseAbs().maxCoeff());
  const auto& fixed = system.body().fixed;
  if (fixed.empty()) return;
  for (Eigen::Index column = 0; column < tangent.cols(); ++column) {
    for (Eigen::Index e = tangent.outerIndexPtr()[column]; e < tangent.outerIndexPtr()[column + 1];
         ++e) {
      const Eigen::Index row = tangent.innerIndexPtr()[e];
      if (!fixed[std::size_t(row)] && !fixed[std::size_t(column)]) continue;
      (row == column ? fixed_diagonal : fixed_entries).push_back(e);
    }
  }
}

/// Sets the force on the free unknowns and, unless null, the tangent; returns the sum of the
/// contact forces' magnitudes.
double EquilibriumSolver::Implementation::evaluate(const StaticContact& contact,
                                                   const VectorXd& displacement, Tangent* matrix) {
  system.assemble(displacement, force, matrix);
  const double sum = contact.add(displacement, system, force, matrix);
  const auto& fixed = system.body().fixed;
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (fixed[i]) force[Eigen::Index(i)] = 0.0;
  if (matrix) hold_fixed();
  return sum;
}

void EquilibriumSolver::Implementation::hold_fixed() {
  for (const Eigen::Index e : fixed_entries) tangent.valuePtr()[e] = 0.0;
  for (const Eigen::Index e : fixed_diagonal) tangent.valuePtr()[e] = 1.0;
}

/// What no iteration removes [N].
double EquilibriumSolver::Implementation::round_off_force() const {
  return round_off * tangent.diagonal().maxCoeff() * extent;
}

/// How far energies of the same state may be apart [J]: an energy is a sum of small differences of
/// what the cells store, which at first touch is far more than it.
double EquilibriumSolver::Implementation::round_off_energy(double energy) const {
  return std::max(1e-10 * std::abs(energy), round_off_force() * extent);
}

/// Where the tangent is not positive definite (springs snapping through), a multiple of the
/// identity is added, the smaller the better: the step then still goes downhill.
bool EquilibriumSolver::Implementation::factorise() {
  const double typical = tangent.diagonal().mean();
  double shift = 0.0;
  for (int i = 0; i < max_shifts; ++i) {
    factor.setShift(shift);
    factor.factorize(tangent);
    require_memory(factor.cholmod(), tangent.rows());
    ++effort.factorisations;
    steps = gradients = last_gradients = 0;
    factorised = factor.info() == Eigen::Success;
    if (factorised) return true;
    shift = shift > 0.0 ? 10.0 * shift : first_shift * typical;
  }
  return false;
}

/// Conjugate gradients for tangent x step = force from step = 0, up to where the energy is found to
/// curve downward: what they have by then goes downhill (Steihaug 1983). False when they take too
/// long.
bool EquilibriumSolver::Implementation::iterate(VectorXd& step) {
  const double enough = step_accuracy * force.norm();
  VectorXd residual = force, z = factor.solve(residual), direction = z, product(step.size());
  step.setZero();
  double slope = residual.dot(z);
  ++steps;
  for (last_gradients = 1; last_gradients <= factor_cost; ++last_gradients) {
    ++gradients;
    product.noalias() = tangent.selfadjointView<Eigen::Lower>() * direction;
    const double curvature = direction.dot(product);
    if (!(slope > 0.0)) return false;
    if (!(curvature > 0.0)) {
      if (last_gradients == 1) step = direction;
      return true;
    }
    step += slope / curvature * direction;
    residual -= slope / curvature * product;
    if (residual.norm() <= enough) return true;
    z = factor.solve(residual);
    const double next = residual.dot(z);
    direction = z + next / slope * direction;
    slope = next;
  }
  return false;
}

/// An old factor serves as long as a step by it costs less than the steps since it was made have
/// cost on average, itself included: the average is then least.
bool EquilibriumSolver::Implementation::find_step(VectorXd& step) {
  step.resize(force.size());
  if (factorised && !factor_is_stale() && iterate(step)) return true;
  if (!factorise()) return false;
  step = factor.solve(force);
  return true;
}

/// Goes along the step, halving it until the energy falls enough; near the minimum, where the
/// energy is all round-off, until the force does.
bool EquilibriumSolver::Implementation::search(const StaticContact& contact, const VectorXd& step,
                                               VectorXd& displacement) {
  const double start = energy(contact, displacement), slope = force.dot(step);
  const double before = force.norm();
  if (!(slope > 0.0) || !std::isfinite(start)) return false;
  const VectorXd origin = displacement;
  double length = 1.0;
  for (int i = 0; i < max_halvings; ++i, length *= 0.5) {
    displacement = origin + length * step;
    const double now = energy(contact, displacement);
    if (!std::isfinite(now)) continue;
    if (now <= start - sufficient_decrease * length * slope) return true;
    if (std::abs(now - start) > round_off_energy(start)) continue;
    evaluate(contact, displacement, nullptr);
    if (force.norm() < before) return true;
  }
  return false;
}

/// Conjugate gradients for all columns side by side, each with coefficients of its own, until its
/// residual is small. False when one meets negative curvature or they cost more than a
/// factorisation.
bool EquilibriumSolver::Implementation::iterate(const MatrixXd& forces, MatrixXd& responses) const {
  const auto product = [this](const MatrixXd& x) -> MatrixXd {
    return tangent.selfadjointView<Eigen::Lower>() * x;
  };
  MatrixXd residual = forces - product(responses);
  MatrixXd direction = MatrixXd::Zero(forces.rows(), forces.cols());
  VectorXd slope = VectorXd::Ones(forces.cols());
  const int most = std::max(fewest_gradients, max_response_gradients / int(forces.cols()));
  for (int i = 0; i < most; ++i) {
    std::vector<Eigen::Index> active;
    for (Eigen::Index j = 0; j < forces.cols(); ++j)
      if (residual.col(j).norm() > response_accuracy * forces.col(j).norm()) active.push_back(j);
    if (active.empty()) return true;
    const MatrixXd z = factor.solve(residual);
    for (const Eigen::Index j : active) {
      const double next = residual.col(j).dot(z.col(j));
      direction.col(j) = z.col(j) + next / slope[j] * direction.col(j);
      slope[j] = next;
    }
    const MatrixXd pull = product(direction);
    for (const Eigen::Index j : active) {
      const double curvature = direction.col(j).dot(pull.col(j));
      if (!(curvature > 0.0)) return false;
      responses.col(j) += slope[j] / curvature * direction.col(j);
      residual.col(j) -= slope[j] / curvature * pull.col(j);
    }
  }
  return false;
}

EquilibriumSolver::EquilibriumSolver(const ElasticSystem& system)
    : implementation_(std::make_unique<Implementation>(system)) {}

EquilibriumSolver::~EquilibriumSolver() = default;

const Effort& EquilibriumSolver::effort() const {
  return implementation_->effort;
}

bool EquilibriumSolver::respond(const StaticContact& contact, const VectorXd& displacement,
                                const MatrixXd& forces, MatrixXd& responses) {
  if (forces.cols() == 0) return true;
  for (Eigen::Index j = 0; j < forces.cols(); ++j)
    if (forces.col(j).isZero(0.0)) responses.col(j).setZero();
  Implementation& own = *implementation_;
  own.evaluate(contact, displacement, &own.tangent);
  if (own.factorised && own.iterate(forces, responses)) return true;
  return own.factorise() && own.iterate(forces, responses);
}

bool EquilibriumSolver::solve(const StaticContact& contact, VectorXd& displacement,
                              double tolerance) {
  Implementation& own = *implementation_;
  VectorXd step;
  for (int i = 0; i < max_iterations; ++i) {
    double contact_force = 0.0;
    try {
      contact_force = own.evaluate(contact, displacement, &own.tangent);
    } catch (const meshes::NotConverged&) {
      return false;
    }
    if (own.force.norm() <= std::max(tolerance * contact_force, own.round_off_force())) return true;
    ++own.effort.newton_iterations;
    if (!own.find_step(step) || !own.search(contact, step, displacement)) return false;
  }
  return false;
}

}  // namespace fingertip::lattice::inline statics
