#include "lattice/statics/equilibrium.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "lattice/statics/block_multigrid.h"

namespace fingertip::lattice::inline statics {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr int max_iterations = 100;
/// Then ties of points that touch stay as stiff as they are: one that a plane aside lifts where it
/// is held and lowers where it is not would come and go for ever.
constexpr int settled = 20;
/// Gradients that cost as much as a new preconditioner (MEASUREMENTS).
constexpr int preparation_cost = 8;
constexpr int max_gradients = 400;
constexpr int max_halvings = 20;
constexpr int max_shifts = 6;
constexpr double first_shift = 1e-3;  // of the mean stiffness
/// Accuracy of a Newton step: what it leaves need not be less than what the next one will find
/// (Eisenstat & Walker, SIAM J. Sci. Comput. 17 (1996) 16, their second choice).
constexpr double worst_accuracy = 0.3, best_accuracy = 1e-3;
/// Of the residual of a response, over its force.
constexpr double response_accuracy = 1e-12;
/// Of displacements, over the body's size.
constexpr double round_off = 1e-15;
/// Share of the decrease promised by the slope that a step must bring (Armijo).
constexpr double sufficient_decrease = 1e-4;

}  // namespace

struct EquilibriumSolver::Implementation {
  Implementation(const ElasticSystem& elastic_system, const Team& team);

  double evaluate(const StaticContact& contact, const VectorXd& displacement, Tangent* tangent);
  double energy(const StaticContact& contact, const VectorXd& displacement) const {
    return system.energy(displacement) + contact.energy(displacement);
  }
  void hold_fixed();
  /// What no iteration removes [N].
  double round_off_force() const { return round_off * largest_stiffness * extent; }
  double round_off_energy(double energy) const;
  bool find_step(double accuracy, VectorXd& step);
  bool prepare(double shift);
  bool iterate(double accuracy, VectorXd& step);
  bool is_stale() const { return last_gradients * steps > preparation_cost + gradients; }
  bool search(const StaticContact& contact, const VectorXd& step, VectorXd& displacement,
              double& stored);
  bool iterate(const MatrixXd& forces, MatrixXd& responses);

  const ElasticSystem& system;
  Tangent tangent;
  VectorXd force;
  std::vector<Eigen::Index> fixed_entries, fixed_diagonal;  ///< of the tangent's values
  BlockMultigrid preconditioner;
  bool prepared = false;
  /// Since the preconditioner was made: Newton steps by it, their gradients, those of the last.
  int steps = 0, gradients = 0, last_gradients = 0;
  double extent = 0.0;             ///< largest coordinate of a particle [m]
  double largest_stiffness = 0.0;  ///< on the tangent's diagonal [N/m]
  Effort effort;
};

EquilibriumSolver::Implementation::Implementation(const ElasticSystem& elastic_system,
                                                  const Team& team)
    : system(elastic_system), tangent(system.empty_tangent()), preconditioner(system, team) {
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
  if (!matrix) return sum;
  hold_fixed();
  largest_stiffness = tangent.diagonal().maxCoeff();
  return sum;
}

void EquilibriumSolver::Implementation::hold_fixed() {
  for (const Eigen::Index e : fixed_entries) tangent.valuePtr()[e] = 0.0;
  for (const Eigen::Index e : fixed_diagonal) tangent.valuePtr()[e] = 1.0;
}

/// How far energies of the same state may be apart [J]: an energy is a sum of small differences of
/// what the cells store, which at first touch is far more than it.
double EquilibriumSolver::Implementation::round_off_energy(double energy) const {
  return std::max(1e-10 * std::abs(energy), round_off_force() * extent);
}

bool EquilibriumSolver::Implementation::prepare(double shift) {
  ++effort.factorisations;
  steps = gradients = last_gradients = 0;
  return prepared = preconditioner.set(tangent, shift);
}

/// Conjugate gradients for tangent x step = force from step = 0, up to where the energy is found to
/// curve downward: what they have by then goes downhill (Steihaug 1983). False when the
/// preconditioner is not positive definite or so old that they take very long.
bool EquilibriumSolver::Implementation::iterate(double accuracy, VectorXd& step) {
  const double enough = accuracy * force.norm();
  VectorXd residual = force, z = preconditioner.solve(residual), direction = z,
           product(step.size());
  step.setZero();
  double slope = residual.dot(z);
  ++steps;
  for (last_gradients = 1; last_gradients <= max_gradients; ++last_gradients) {
    ++gradients;
    ++effort.gradients;
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
    z = preconditioner.solve(residual);
    const double next = residual.dot(z);
    direction = z + next / slope * direction;
    slope = next;
  }
  return steps == 1;  // what they have goes downhill
}

/// An old preconditioner serves as long as a step by it costs less than the steps since it was made
/// have cost on average, itself included: the average is then least. Where the present tangent is
/// not positive definite (springs snapping through), the new one is that of a multiple of the
/// identity more, the smaller the better.
bool EquilibriumSolver::Implementation::find_step(double accuracy, VectorXd& step) {
  step.resize(force.size());
  if (prepared && !is_stale() && iterate(accuracy, step)) return true;
  const double typical = tangent.diagonal().mean();
  double shift = 0.0;
  for (int i = 0; i < max_shifts; ++i) {
    if (prepare(shift) && iterate(accuracy, step)) return true;
    shift = shift > 0.0 ? 10.0 * shift : first_shift * typical;
  }
  return prepared = false;
}

/// Goes along the step, halving it until the energy `stored` falls enough; near the minimum, where
/// the energy is all round-off, until the force does.
bool EquilibriumSolver::Implementation::search(const StaticContact& contact, const VectorXd& step,
                                               VectorXd& displacement, double& stored) {
  const double start = stored, slope = force.dot(step);
  const double before = force.norm();
  if (!(slope > 0.0) || !std::isfinite(start)) return false;
  const VectorXd origin = displacement;
  double length = 1.0;
  for (int i = 0; i < max_halvings; ++i, length *= 0.5) {
    displacement = origin + length * step;
    const double now = stored = energy(contact, displacement);
    if (!std::isfinite(now)) continue;
    if (now <= start - sufficient_decrease * length * slope) return true;
    if (std::abs(now - start) > round_off_energy(start)) continue;
    evaluate(contact, displacement, nullptr);
    if (force.norm() < before) return true;
  }
  return false;
}

/// Conjugate gradients for all columns side by side, each with coefficients of its own, until its
/// residual is small. False when one meets negative curvature or they take too long.
bool EquilibriumSolver::Implementation::iterate(const MatrixXd& forces, MatrixXd& responses) {
  const auto product = [this](const MatrixXd& x) -> MatrixXd {
    return tangent.selfadjointView<Eigen::Lower>() * x;
  };
  MatrixXd residual = forces - product(responses);
  MatrixXd direction = MatrixXd::Zero(forces.rows(), forces.cols());
  VectorXd slope = VectorXd::Ones(forces.cols());
  for (int i = 0; i < max_gradients; ++i) {
    std::vector<Eigen::Index> active;
    for (Eigen::Index j = 0; j < forces.cols(); ++j)
      if (residual.col(j).norm() > response_accuracy * forces.col(j).norm()) active.push_back(j);
    if (active.empty()) return true;
    for (const Eigen::Index j : active) {
      const VectorXd z = preconditioner.solve(residual.col(j));
      const double next = residual.col(j).dot(z);
      if (!(next > 0.0)) return false;
      direction.col(j) = z + next / slope[j] * direction.col(j);
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

EquilibriumSolver::EquilibriumSolver(const ElasticSystem& system, const Team& team)
    : implementation_(std::make_unique<Implementation>(system, team)) {}

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
  return own.prepare(0.0) && own.iterate(forces, responses);
}

bool EquilibriumSolver::solve(StaticContact& contact, VectorXd& displacement, double tolerance) {
  Implementation& own = *implementation_;
  VectorXd step;
  double before = 0.0, stored = 0.0;
  for (int i = 0; i < max_iterations; ++i) {
    double contact_force = 0.0;
    contact.update_ties(displacement, i < settled);
    try {
      contact_force = own.evaluate(contact, displacement, &own.tangent);
    } catch (const meshes::NotConverged&) {
      return false;
    }
    const double enough = std::max(tolerance * contact_force, own.round_off_force()),
                 now = own.force.norm();
    if (now <= enough) return true;
    ++own.effort.newton_iterations;
    if (i == 0 || contact.holds()) stored = own.energy(contact, displacement);
    const double found = i == 0 ? worst_accuracy : std::pow(now / before, 2),
                 accuracy =
                     std::clamp(std::max(found, 0.5 * enough / now), best_accuracy, worst_accuracy);
    before = now;
    if (!own.find_step(accuracy, step) || !own.search(contact, step, displacement, stored))
      return false;
  }
  return false;
}

}  // namespace fingertip::lattice::inline statics
