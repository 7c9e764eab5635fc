/// Newton's method for the equilibrium of a lattice body in contact.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "lattice/statics/elastic_system.h"
#include "lattice/statics/static_contact.h"
#include "lattice/threads/parallel.h"

namespace fingertip::lattice::inline statics {

/// Force that may be left unbalanced, over the sum of the contact forces' magnitudes.
inline constexpr double force_tolerance = 1e-9;

/// What a search for equilibrium has cost.
struct Effort {
  int newton_iterations = 0;
  int factorisations = 0;  ///< of coarsest grids: preconditioners made
  int gradients = 0;       ///< of conjugate gradients for Newton's steps
};

/// Finds displacements at which elastic and contact forces on the free unknowns cancel, by Newton's
/// method (semi-smooth where a tie opens or closes) with a backtracking line search on the energy.
/// Under Coulomb friction the energy of an iteration is that of the pushes it starts from.
///
/// Linear systems are solved by conjugate gradients, no better than the next step can use, with a
/// V-cycle (BlockMultigrid) of an earlier tangent; when that takes too long, of the present one.
/// The cost of a step is linear in the unknowns.
class EquilibriumSolver {
 public:
  /// Keeps a reference to `system`. The result does not depend on the number of threads.
  explicit EquilibriumSolver(const ElasticSystem& system, const Team& team = Team(1));
  ~EquilibriumSolver();

  /// Improves `displacement` until |force| <= `tolerance` x the sum of the contact forces'
  /// magnitudes, or round-off. False, and the displacement is of no use, when the start has no
  /// finite energy, no shift makes the tangent positive definite, the line search fails or 100
  /// iterations do not suffice. Fixed unknowns keep their values.
  bool solve(StaticContact& contact, Eigen::VectorXd& displacement,
             double tolerance = force_tolerance);

  /// Solves tangent x `responses` = `forces` column by column to a relative residual of 1e-12, with
  /// the tangent at `displacement` in contact: how an equilibrium answers small forces. On entry
  /// `responses`, as large as `forces`, is a first guess; fixed unknowns must be zero in both.
  /// False where the tangent is not positive definite. Throws NotConverged where it is infinite.
  bool respond(const StaticContact& contact, const Eigen::VectorXd& displacement,
               const Eigen::MatrixXd& forces, Eigen::MatrixXd& responses);

  /// So far, of all calls.
  const Effort& effort() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace fingertip::lattice::inline statics
