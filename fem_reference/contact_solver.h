/// Solves the elastic tip with prescribed displacements of its contact unknowns: the one linear
/// problem that the contact algorithm asks for again and again. Free of deal.II.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "fem_reference/elastic_tip.h"

namespace fingertip::fem_reference {

/// Answer on the contact unknowns, in the order in which they were given.
struct HeldSolution {
  Eigen::VectorXd displacement;  ///< [m]
  Eigen::VectorXd reaction;      ///< force that holds the unknown, 0 where it is free [N]
  int cg_iterations = 0;         ///< 0 from a direct solver
};

class ContactSolver {
 public:
  virtual ~ContactSolver() = default;

  /// Equilibrium with contact unknown i at `values[i]` [m] where `held[i]` is 1 and free of force
  /// elsewhere. Both have one entry per contact unknown. Throws NotConverged.
  virtual HeldSolution hold(const std::vector<char>& held, const Eigen::VectorXd& values) = 0;

  /// Displacement of all unknowns of the tip at the last `hold` [m].
  virtual Eigen::VectorXd field() = 0;

  /// Reactions below this fraction of the largest one are noise.
  virtual double noise() const = 0;
};

/// Condenses the stiffness to the contact unknowns once, by a sparse Cholesky factorisation in
/// which they come last; every `hold` is then a small dense problem. Memory grows like n^(4/3).
/// Throws NotConverged when the factorisation fails.
std::unique_ptr<ContactSolver> make_condensed_solver(const ElasticTip& tip,
                                                     const std::vector<int>& contact_unknowns);

/// Conjugate gradients preconditioned by algebraic multigrid (Trilinos ML), to the relative
/// residual `tolerance`. The multigrid hierarchy belongs to the tip without contact and is built
/// once; held unknowns are projected out of both operators. Starts from the previous solution.
std::unique_ptr<ContactSolver> make_multigrid_solver(const ElasticTip& tip,
                                                     const std::vector<int>& contact_unknowns,
                                                     double tolerance);

}  // namespace fingertip::fem_reference
