/// The one linear problem that the contact algorithm asks for again and again. Free of deal.II.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fingertip::fem_reference::inline contact {

/// Answer on the contact unknowns, in the order in which they were given.
struct ConstrainedSolution {
  Eigen::VectorXd displacement;  ///< [m]
  Eigen::VectorXd reaction;      ///< force that holds the unknown; where it is free its load [N]
  int cg_iterations = 0;         ///< 0 from a direct solver
};

class ContactSolver {
 public:
  virtual ~ContactSolver() = default;

  /// Equilibrium with contact unknown i at `values[i]` [m] where `held[i]` is 1, and under the
  /// force `loads[i]` [N] elsewhere. All three have one entry per contact unknown; every process
  /// calls it with the same arguments and gets the same answer. Throws NotConverged.
  virtual ConstrainedSolution solve_constrained(const std::vector<char>& held,
                                                const Eigen::VectorXd& values,
                                                const Eigen::VectorXd& loads) = 0;

  /// Reactions below this fraction of the largest one are noise.
  virtual double noise() const = 0;
};

}  // namespace fingertip::fem_reference::inline contact
