/// An approximate inverse of inertia plus a graph Laplacian, that never exceeds it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "lattice/dynamics/scaling/edge_inertia.h"
#include "lattice/dynamics/scaling/grid_hierarchy.h"
#include "lattice/dynamics/scaling/sweeps.h"
#include "lattice/model/state.h"
#include "lattice/threads/parallel.h"

namespace fingertip::lattice::inline dynamics::inline scaling {

using sweeps::Single;

/// Inertia of a point against a plane [kg].
struct PointTie {
  std::uint32_t point = 0;
  Eigen::Matrix3f inertia = Eigen::Matrix3f::Zero();
};

/// What Multigrid::solve works with.
struct MultigridFields {
  using Field = std::array<std::vector<Single>, 3>;
  struct Level {
    Field load, solution, residual;
    Field gathered, stretched;  ///< on the sheet to the coarser grid, down and up
    std::vector<PointTie> contact;
    std::vector<std::int32_t> contact_at;  ///< per point: its place in `contact`, or -1
  };
  std::vector<Level> levels;
  explicit MultigridFields(const GridHierarchy& hierarchy);
};

/// A = D + S on the finest grid: D a diagonal inertia, S u·u = Σ_edges c (u_i - u_j)², with its own
/// c for each of the three components of a vector. solve() is one V-cycle with one damped Jacobi
/// sweep before and after, from zero: a fixed symmetric matrix B > 0.
///
/// B <= A⁻¹ (as quadratic forms), because every coarser matrix is not below the Galerkin product Pᵀ
/// A P of the finer: the difference along a fine edge is a mean of differences along coarse ones,
/// half as large, and a square of a mean is at most the mean of the squares. So a coarse edge gets
/// a quarter of c times its share, a coarse point the inertia times its share. Then 1 - B A = (1 -
/// R A)(1 - P Ac⁻¹ Pᵀ A)(1 - R A), whose middle factor is not negative in the product <., A .>, and
/// neither is the whole. Trottenberg, Oosterlee & Schueller, Multigrid (2001), has the cycle.
///
/// What planes add is told with every solve; coarser grids get their shares of it. Where a mirror
/// plane holds a component its relaxation is 0 on every grid, and so is the solution: coarse points
/// on the plane alone are interpolated to it, and what it passes on goes to these.
class Multigrid {
 public:
  /// Of zero matrices.
  explicit Multigrid(std::shared_ptr<const GridHierarchy> hierarchy);

  /// The c of the finest grid, to be written before set().
  EdgeInertia& finest_edges() { return matrices_.front().edge; }
  /// `inertia` D per point [kg], positive at nodes.
  void set(const std::vector<double>& inertia, Team& team);

  /// levels[0].solution = B levels[0].load; load, 0 where no node is, and levels[0].contact have
  /// been set.
  void solve(Team& team, MultigridFields& fields) const;

 private:
  using Field = MultigridFields::Field;
  struct Matrix {
    EdgeInertia edge;
    std::vector<Single> inertia;                 ///< D
    Field relaxation;                            ///< 1/(D + 13/10 of S's diagonal); 0: held
    std::array<std::vector<Single>, 10> sheets;  ///< scratch: of the nine kinds of edges, and D
    /// What relaxation is one over, also where it is held.
    Single diagonal(const GridLevel& grid, std::size_t component, std::size_t point) const;
  };
  class Cycle;
  void finish(std::size_t level, Team& team);
  void coarsen(std::size_t level, Team& team);

  std::shared_ptr<const GridHierarchy> hierarchy_;
  std::vector<Matrix> matrices_;
};

}  // namespace fingertip::lattice::inline dynamics::inline scaling
