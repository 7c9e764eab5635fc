/// An approximate inverse of a lattice's stiffness at a cost that is linear in its unknowns.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "lattice/statics/elastic_system.h"
#include "lattice/threads/parallel.h"

namespace fingertip::lattice::inline statics {

/// One V-cycle over the particles' grid and ever coarser ones over it, as a preconditioner of
/// conjugate gradients: B, symmetric and positive definite if the matrix is.
///
/// Coarser grids keep the even points of finer ones, interpolate trilinearly and have Galerkin's
/// matrix; so whatever the energy has, ties and nearly incompressible cells included, they have,
/// too. Sweeps are Gauss-Seidel's over the 3 x 3 blocks of the particles, forward before and
/// backward after the coarser grid, in the order of the places' eight parities, so that a team's
/// threads share them with the same bits for any number. They are done in single precision: what is
/// lost there, conjugate gradients correct. The coarsest matrix, and that
/// of a body without places, is factorised (supernodal CHOLMOD).
class BlockMultigrid {
 public:
  /// Keeps a reference to `system`. Throws NotConverged when there is too little memory.
  explicit BlockMultigrid(const ElasticSystem& system, const Team& team = Team(1));
  ~BlockMultigrid();

  /// Prepares for matrix + shift x 1, the matrix with the system's pattern and 1 on the diagonal of
  /// fixed unknowns. False where it is not positive definite as far as this sees it, which need not
  /// be everywhere. Throws NotConverged when there is too little memory.
  bool set(const Tangent& matrix, double shift);
  /// B x load; fixed unknowns of `load` are zero. After set() was true.
  Eigen::VectorXd solve(const Eigen::VectorXd& load);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace fingertip::lattice::inline statics
