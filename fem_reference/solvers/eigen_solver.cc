#include "fem_reference/solvers/eigen_solver.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/petsc_sparse_matrix.h>
#include <deal.II/lac/sparsity_tools.h>
#include <slepceps.h>

#include <algorithm>
#include <memory>
#include <string>

#include "meshes/base/errors.h"

namespace fingertip::fem_reference::inline solvers {
namespace {

using PetscMatrix = dealii::PETScWrappers::MPI::SparseMatrix;

/// Relative change of an eigenvalue at which the iteration ends.
constexpr double residual_tolerance = 1e-11;
/// Restarts before the iteration gives up; a handful is usual.
constexpr int max_restarts = 200;

void check(PetscErrorCode code) {
  if (code != 0)
    throw meshes::NotConverged("the eigenvalue solver failed (PETSc error " +
                               std::to_string(int(code)) + "); is memory short?");
}

struct DestroySolver {
  void operator()(EPS solver) const { EPSDestroy(&solver); }
};
using Solver = std::unique_ptr<std::remove_pointer_t<EPS>, DestroySolver>;

dealii::DynamicSparsityPattern pattern_of(const Space<3>& space) {
  dealii::DynamicSparsityPattern pattern(space.relevant);
  dealii::DoFTools::make_sparsity_pattern(space.dofs, pattern, space.constraints, false);
  dealii::SparsityTools::distribute_sparsity_pattern(pattern, space.owned, space.communicator,
                                                     space.relevant);
  return pattern;
}

void fill(const Body<3>& body, ElementKernel<3>& kernel, PetscMatrix& matrix) {
  std::vector<dealii::types::global_dof_index> indices(body.fine.element.n_dofs_per_cell());
  for_each_element(body, kernel, body.fine.vector(),
                   [&](const CellIterator<3>& cell, const dealii::FullMatrix<double>& element,
                       const dealii::Vector<double>&, const ElementSystem&) {
                     cell->get_dof_indices(indices);
                     body.fine.constraints.distribute_local_to_global(element, indices, matrix);
                   });
  matrix.compress(dealii::VectorOperation::add);
}

void drop_constrained_mass(const Space<3>& space, PetscMatrix& mass) {
  for (const auto i : space.owned)
    if (space.constraints.is_constrained(i)) mass.set(i, i, 0.0);
  mass.compress(dealii::VectorOperation::insert);
}

/// Inverse iteration needs K x = b solved exactly: a Cholesky factorisation on all processes.
void use_cholesky(EPS solver) {
  ST transformation = nullptr;
  KSP linear = nullptr;
  PC factorisation = nullptr;
  check(EPSGetST(solver, &transformation));
  check(STSetType(transformation, STSINVERT));
  check(STSetShift(transformation, 0.0));
  check(STGetKSP(transformation, &linear));
  check(KSPSetType(linear, KSPPREONLY));
  check(KSPGetPC(linear, &factorisation));
  check(PCSetType(factorisation, PCCHOLESKY));
  check(PCFactorSetMatSolverType(factorisation, MATSOLVERMUMPS));
}

Solver solve(MPI_Comm communicator, const PetscMatrix& stiffness, const PetscMatrix& mass,
             int count) {
  EPS raw = nullptr;
  check(EPSCreate(communicator, &raw));
  Solver solver(raw);
  check(EPSSetOperators(raw, stiffness, mass));
  check(EPSSetProblemType(raw, EPS_GHEP));
  check(EPSSetType(raw, EPSKRYLOVSCHUR));
  check(EPSSetDimensions(raw, count, PETSC_DEFAULT, PETSC_DEFAULT));
  check(EPSSetTolerances(raw, residual_tolerance, max_restarts));
  check(EPSSetTarget(raw, 0.0));
  check(EPSSetWhichEigenpairs(raw, EPS_TARGET_MAGNITUDE));
  use_cholesky(raw);
  check(EPSSolve(raw));
  return solver;
}

/// Copies the owned entries of a PETSc vector.
Vector copy(Vec source, const Space<3>& space) {
  Vector result = space.vector();
  const PetscScalar* values = nullptr;
  check(VecGetArrayRead(source, &values));
  std::copy(values, values + space.owned.n_elements(), result.begin());
  check(VecRestoreArrayRead(source, &values));
  for (const auto i : space.owned)
    if (space.constraints.is_constrained(i)) result[i] = 0.0;
  result.compress(dealii::VectorOperation::insert);
  return result;
}

}  // namespace

std::vector<Eigenpair> lowest_eigenpairs(const Body<3>& body, ElementKernel<3>& stiffness_kernel,
                                         ElementKernel<3>& mass_kernel, int count) {
  const Space<3>& space = body.fine;
  const dealii::DynamicSparsityPattern pattern = pattern_of(space);
  PetscMatrix stiffness, mass;
  stiffness.reinit(space.owned, space.owned, pattern, space.communicator);
  mass.reinit(space.owned, space.owned, pattern, space.communicator);
  fill(body, stiffness_kernel, stiffness);
  fill(body, mass_kernel, mass);
  drop_constrained_mass(space, mass);
  check(MatSetOption(stiffness, MAT_SPD, PETSC_TRUE));
  check(MatSetOption(mass, MAT_SYMMETRIC, PETSC_TRUE));

  const Solver solver = solve(space.communicator, stiffness, mass, count);
  PetscInt found = 0;
  check(EPSGetConverged(solver.get(), &found));
  if (found < count)
    throw meshes::NotConverged("only " + std::to_string(int(found)) + " of " +
                               std::to_string(count) + " natural frequencies converged");
  Vec vector = nullptr;
  check(MatCreateVecs(stiffness, &vector, nullptr));
  std::vector<Eigenpair> pairs;
  for (PetscInt i = 0; i < count; ++i) {
    Eigenpair pair;
    check(EPSGetEigenpair(solver.get(), i, &pair.eigenvalue, nullptr, vector, nullptr));
    pair.shape = copy(vector, space);
    pairs.push_back(std::move(pair));
  }
  check(VecDestroy(&vector));
  std::ranges::sort(pairs, {}, &Eigenpair::eigenvalue);
  return pairs;
}

}  // namespace fingertip::fem_reference::inline solvers
