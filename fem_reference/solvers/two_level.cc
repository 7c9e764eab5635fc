#include "fem_reference/solvers/two_level.h"

#include <Epetra_Import.h>
#include <ml_MultiLevelPreconditioner.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/parallel.h>
#include <deal.II/fe/fe_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparsity_tools.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace fingertip::fem_reference::inline solvers {
namespace {

using dealii::types::global_dof_index;

/// Chebyshev smoother: degree, and the part of the spectrum it damps, largest over smallest.
/// Quadratic elements, 78 000 unknowns, to 1e-10: (3, 12) 46 iterations, (4, 20) 37, (5, 30) 31,
/// all for about the same time.
constexpr unsigned smoother_degree = 4;
constexpr double smoother_range = 20.0;
/// Rows of a matrix that a thread multiplies at once.
constexpr unsigned rows_at_once = 2000;
/// Of the Lanczos method, for the largest eigenvalue.
constexpr unsigned eigenvalue_rounds = 10;

/// Coarse unknowns and weights that make up one fine unknown.
using Row = std::vector<std::pair<global_dof_index, double>>;

/// Adds `weight` times a coarse unknown, hanging ones replaced by their masters.
void add_resolved(const dealii::AffineConstraints<double>& constraints, global_dof_index unknown,
                  double weight, Row& row) {
  if (!constraints.is_constrained(unknown)) {
    row.emplace_back(unknown, weight);
  } else {
    for (const auto& [master, factor] : *constraints.get_constraint_entries(unknown))
      row.emplace_back(master, factor * weight);
  }
}

/// Calls `take(i, row)` for every owned fine unknown that is free, at least once.
template <class Take>
void for_each_row(const Body<3>& body, Take take) {
  dealii::FullMatrix<double> embedding(body.fine.element.n_dofs_per_cell(),
                                       body.coarse.element.n_dofs_per_cell());
  dealii::FETools::get_interpolation_matrix(body.coarse.element, body.fine.element, embedding);
  std::vector<global_dof_index> fine(embedding.m()), coarse(embedding.n());
  std::vector<char> done(body.fine.owned.n_elements(), 0);
  for (const auto& cell : body.fine.dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    cell->get_dof_indices(fine);
    CellIterator<3>(&body.triangulation, cell->level(), cell->index(), &body.coarse.dofs)
        ->get_dof_indices(coarse);
    for (unsigned i = 0; i < fine.size(); ++i) {
      if (!body.fine.owned.is_element(fine[i]) || body.fine.constraints.is_constrained(fine[i]))
        continue;
      char& seen = done[body.fine.owned.index_within_set(fine[i])];
      if (seen) continue;
      seen = 1;
      Row row;
      for (unsigned j = 0; j < coarse.size(); ++j)
        if (std::abs(embedding(i, j)) > 1e-12)
          add_resolved(body.coarse.constraints, coarse[j], embedding(i, j), row);
      take(fine[i], row);
    }
  }
}

/// Zeroes rows and columns of the held unknowns but for the diagonal.
void eliminate(const std::vector<char>& held, SparseMatrix& matrix) {
  const Epetra_CrsMatrix& rows = matrix.trilinos_matrix();
  Epetra_Vector own(rows.RowMap()), seen(rows.ColMap());
  for (std::size_t i = 0; i < held.size(); ++i) own[int(i)] = held[i];
  if (rows.Importer() != nullptr)
    seen.Import(own, *rows.Importer(), Insert);
  else
    seen = own;
  for (int i = 0; i < rows.NumMyRows(); ++i) {
    int entries = 0;
    int* columns = nullptr;
    double* values = nullptr;
    rows.ExtractMyRowView(i, entries, values, columns);
    for (int e = 0; e < entries; ++e)
      if (rows.GCID(columns[e]) != rows.GRID(i) && (own[i] != 0.0 || seen[columns[e]] != 0.0))
        values[e] = 0.0;
  }
}

}  // namespace

void ProjectedMatrix::project(Vector& v) const {
  double* entries = v.begin();
  for (std::size_t i = 0; i < held_.size(); ++i)
    if (held_[i]) entries[i] = 0.0;
}

void multiply(const SparseMatrix& matrix, const Vector& v, Vector& result) {
  const Epetra_CrsMatrix& crs = matrix.trilinos_matrix();
  int *offsets = nullptr, *columns = nullptr;
  double* values = nullptr;
  if (crs.Importer() != nullptr || crs.ExtractCrsDataPointers(offsets, columns, values) != 0) {
    matrix.vmult(result, v);  // shared among processes
    return;
  }
  const double* from = v.begin();
  double* to = result.begin();
  dealii::parallel::apply_to_subranges(
      0, crs.NumMyRows(),
      [&](int begin, int end) {
        for (int row = begin; row < end; ++row) {
          double sum = 0.0;
          for (int e = offsets[row]; e < offsets[row + 1]; ++e) sum += values[e] * from[columns[e]];
          to[row] = sum;
        }
      },
      rows_at_once);
}

void ProjectedMatrix::vmult(Vector& result, const Vector& v) const {
  multiply(matrix_, v, result);
  project(result);
}

TwoLevelPreconditioner::TwoLevelPreconditioner(const Body<3>& body, const LinearSystem& system)
    : body_(body), system_(system) {
  build_prolongation();
  coarse_matrix_.reinit(body.coarse.matrix());
  collect_rigid_modes();
}

void TwoLevelPreconditioner::collect_rigid_modes() {
  const Space<3>& coarse = body_.coarse;
  rigid_modes_.assign(6 * coarse.owned.n_elements(), 0.0);
  const std::size_t n = coarse.owned.n_elements();
  for (const auto& cell : coarse.dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    const CellIterator<3> fine_cell(&body_.triangulation, cell->level(), cell->index(),
                                    &body_.fine.dofs);
    for (const unsigned vertex : cell->vertex_indices()) {
      const dealii::Point<3> x = cell->vertex(vertex);
      const double size = 0.01;  // brings rotations to the translations' order of magnitude
      for (unsigned c = 0; c < 3; ++c) {
        const global_dof_index unknown = cell->vertex_dof_index(vertex, c);
        if (!coarse.owned.is_element(unknown)) continue;
        const std::size_t row = coarse.owned.index_within_set(unknown);
        rigid_modes_[c * n + row] = 1.0;
        // Rotation about axis k moves component c by e_ckl-signed coordinates.
        const unsigned next = (c + 1) % 3, last = (c + 2) % 3;
        rigid_modes_[(3 + next) * n + row] = x[last] / size;
        rigid_modes_[(3 + last) * n + row] = -x[next] / size;
        shared_vertices_.emplace_back(
            int(body_.fine.owned.index_within_set(fine_cell->vertex_dof_index(vertex, c))),
            int(row));
      }
    }
  }
}

void TwoLevelPreconditioner::build_prolongation() {
  const Space<3>&fine = body_.fine, &coarse = body_.coarse;
  dealii::DynamicSparsityPattern pattern(fine.dofs.n_dofs(), coarse.dofs.n_dofs(), fine.owned);
  for_each_row(body_, [&](global_dof_index i, const Row& row) {
    for (const auto& [j, weight] : row) pattern.add(i, j);
  });
  prolongation_.reinit(fine.owned, coarse.owned, pattern, fine.communicator);
  for_each_row(body_, [&](global_dof_index i, const Row& row) {
    for (const auto& [j, weight] : row) prolongation_.add(i, j, weight);
  });
  prolongation_.compress(dealii::VectorOperation::add);
}

void TwoLevelPreconditioner::set_held(const std::vector<char>& held) {
  smoother_.clear();
  Vector inverse = body_.fine.vector();
  for (const auto i : body_.fine.owned) inverse[i] = 1.0 / system_.matrix.diag_element(i);
  inverse.compress(dealii::VectorOperation::insert);
  jacobi_ = std::make_shared<Jacobi>(Jacobi{inverse});
  projected_ = std::make_unique<ProjectedMatrix>(system_.matrix, held);
  decltype(smoother_)::AdditionalData chebyshev(smoother_degree, smoother_range, eigenvalue_rounds);
  chebyshev.preconditioner = jacobi_;
  for (const auto i : body_.fine.owned)
    if (held[body_.fine.owned.index_within_set(i)]) chebyshev.constraints.add_line(i);
  chebyshev.constraints.close();
  smoother_.initialize(*projected_, chebyshev);
  std::vector<char> coarse_held(body_.coarse.owned.n_elements(), 0);
  for (const auto& [fine, coarse] : shared_vertices_)
    if (fine >= 0) coarse_held[std::size_t(coarse)] = held[std::size_t(fine)];
  build_hierarchy(coarse_held);
}

void TwoLevelPreconditioner::build_hierarchy(const std::vector<char>& coarse_held) {
  amg_.reset();
  coarse_matrix_.copy_from(system_.coarse_matrix);
  eliminate(coarse_held, coarse_matrix_);
  Teuchos::ParameterList parameters;
  ML_Epetra::SetDefaults("SA", parameters);
  parameters.set("ML output", 0);
  parameters.set("PDE equations", 3);
  parameters.set("null space: type", "pre-computed");
  parameters.set("null space: dimension", 6);
  parameters.set("null space: vectors", rigid_modes_.data());
  parameters.set("aggregation: type", "Uncoupled");
  parameters.set("aggregation: threshold", 0.0);
  parameters.set("smoother: type", "Chebyshev");
  parameters.set("smoother: sweeps", 3);
  parameters.set("smoother: Chebyshev alpha", 12.0);
  parameters.set("coarse: type", "Amesos-KLU");
  parameters.set("coarse: max size", 1500);
  amg_ = std::make_unique<dealii::TrilinosWrappers::PreconditionAMG>();
  amg_->initialize(coarse_matrix_, parameters);
}

void TwoLevelPreconditioner::vmult(Vector& result, const Vector& residual) const {
  Vector defect = residual, correction = residual;
  const auto update_defect = [&] {
    projected_->vmult(defect, result);
    defect.sadd(-1.0, 1.0, residual);
    projected_->project(defect);
  };
  smoother_.vmult(result, residual);
  update_defect();

  Vector coarse_defect = body_.coarse.vector(), coarse_correction = coarse_defect;
  prolongation_.Tvmult(coarse_defect, defect);
  amg_->vmult(coarse_correction, coarse_defect);
  prolongation_.vmult(correction, coarse_correction);
  projected_->project(correction);
  result += correction;

  update_defect();
  smoother_.vmult(correction, defect);
  result += correction;
}

}  // namespace fingertip::fem_reference::inline solvers
