/// Two-level preconditioner for higher-order elements: Chebyshev smoothing of the unknowns
/// themselves and one V-cycle of algebraic multigrid for linear elements on the same mesh.
#pragma once

#include <deal.II/base/subscriptor.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/trilinos_precondition.h>

#include <memory>
#include <vector>

#include "fem_reference/elements/assembly.h"

namespace fingertip::fem_reference::inline solvers {

/// A v; on one process by all its threads, with the same bits whatever their number.
void multiply(const SparseMatrix& matrix, const Vector& v, Vector& result);

/// P A P for an operator A that leaves its argument alone; P zeroes the held unknowns.
class ProjectedMatrix : public dealii::Subscriptor {
 public:
  /// `held` has one flag per owned unknown; both must outlive this object.
  ProjectedMatrix(const SparseMatrix& matrix, const std::vector<char>& held)
      : matrix_(matrix), held_(held) {}

  void project(Vector& v) const;
  void vmult(Vector& result, const Vector& v) const;

 private:
  const SparseMatrix& matrix_;
  const std::vector<char>& held_;
};

/// Symmetric positive definite approximation of (P A P)^-1.
class TwoLevelPreconditioner {
 public:
  /// The system must outlive the preconditioner.
  TwoLevelPreconditioner(const Body<3>& body, const LinearSystem& system);

  /// Takes the system as it is now and these held unknowns, one flag per owned unknown of the fine
  /// space, and builds smoother and hierarchy for them. Both are kept by reference and may change a
  /// little afterwards: diagonal, spectrum and coarse level then lag behind.
  void set_held(const std::vector<char>& held);
  void vmult(Vector& result, const Vector& residual) const;

 private:
  void build_prolongation();
  void collect_rigid_modes();
  void build_hierarchy(const std::vector<char>& coarse_held);

  const Body<3>& body_;
  const LinearSystem& system_;
  SparseMatrix prolongation_;  ///< (fine unknowns, coarse unknowns)
  struct Jacobi {
    Vector inverse_diagonal;
    void vmult(Vector& result, const Vector& v) const {
      result = v;
      result.scale(inverse_diagonal);
    }
  };
  std::shared_ptr<Jacobi> jacobi_;
  std::unique_ptr<ProjectedMatrix> projected_;
  dealii::PreconditionChebyshev<ProjectedMatrix, Vector, Jacobi> smoother_;
  SparseMatrix coarse_matrix_;  ///< with held unknowns eliminated
  std::vector<double> rigid_modes_;
  std::unique_ptr<dealii::TrilinosWrappers::PreconditionAMG> amg_;
  std::vector<std::pair<int, int>> shared_vertices_;  ///< (local fine, local coarse) unknowns
};

}  // namespace fingertip::fem_reference::inline solvers
