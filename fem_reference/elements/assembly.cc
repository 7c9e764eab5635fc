#include "fem_reference/elements/assembly.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/work_stream.h>
#include <deal.II/fe/fe_tools.h>
#include <deal.II/grid/filtered_iterator.h>

#include <Eigen/SparseCore>
#include <algorithm>
#include <memory>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "meshes/base/blas.h"
#include "meshes/base/errors.h"

namespace fingertip::fem_reference::inline elements {
namespace {

using dealii::types::global_dof_index;

/// Position of every local unknown in the element's order, node by node.
template <int dim>
std::vector<Eigen::Index> element_order(const dealii::FESystem<dim>& element) {
  std::vector<Eigen::Index> order(element.n_dofs_per_cell());
  for (unsigned i = 0; i < order.size(); ++i) {
    const auto [component, node] = element.system_to_component_index(i);
    order[i] = Eigen::Index(element.n_components() * node + component);
  }
  return order;
}

/// A failure on one process must be a failure on all, or the others would wait for ever.
void agree(const std::string& failure, MPI_Comm communicator) {
  const auto all = dealii::Utilities::MPI::all_gather(communicator, failure);
  const auto first = std::ranges::find_if(all, [](const std::string& s) { return !s.empty(); });
  if (first != all.end()) throw meshes::NotConverged(*first);
}

/// Curved sides may cross where corners tell nothing of it.
template <int dim>
void refuse_crossed_sides(const dealii::FEValues<dim>& values) {
  for (unsigned q = 0; q < values.n_quadrature_points; ++q)
    if (!(values.JxW(q) > 0.0))
      throw meshes::NotConverged(
          "an element of the mesh is turned inside out by its curved sides; halve "
          "reference.refinement, or leave out fillets that are small beside the elements");
}

/// What a thread needs to integrate elements.
template <int dim>
struct Work {
  dealii::FEValues<dim> values;
  std::unique_ptr<ElementKernel<dim>> kernel;
  std::vector<global_dof_index> indices;
  Eigen::VectorXd local;

  Work(const Body<dim>& body, const ElementKernel<dim>& original)
      : values(body.mapping, body.fine.element.base_element(0),
               dealii::QGauss<dim>(body.fine.element.degree + 1),
               dealii::update_values | dealii::update_gradients | dealii::update_quadrature_points |
                   dealii::update_JxW_values),
        kernel(original.clone()),
        indices(body.fine.element.n_dofs_per_cell()),
        local(Eigen::Index(indices.size())) {}
  Work(const Work& other)
      : values(other.values.get_mapping(), other.values.get_fe(), other.values.get_quadrature(),
               other.values.get_update_flags()),
        kernel(other.kernel->clone()),
        indices(other.indices),
        local(other.local) {}
};

/// An element's system on its way from the thread that made it.
template <int dim>
struct Contribution {
  CellIterator<dim> cell;
  ElementSystem element;
  dealii::FullMatrix<double> matrix;
  dealii::Vector<double> force;
  std::string failure;

  explicit Contribution(std::size_t unknowns)
      : matrix(unsigned(unknowns), unsigned(unknowns)), force(unsigned(unknowns)) {}
};

/// Sums the matrices of elements up in a global one. deal.II searches a row for each of their
/// entries; where all rows are this process' and no unknown is constrained, a walk along the row
/// meets all of them.
class MatrixSum {
 public:
  MatrixSum(const dealii::AffineConstraints<double>& constraints, SparseMatrix& matrix)
      : constraints_(constraints),
        matrix_(matrix),
        is_whole_(matrix.trilinos_matrix().Comm().NumProc() == 1) {
    matrix = 0.0;
  }

  void add(const dealii::FullMatrix<double>& element, const std::vector<global_dof_index>& dofs) {
    if (!is_whole_ || std::ranges::any_of(dofs, [this](global_dof_index i) {
          return constraints_.is_constrained(i);
        })) {
      constraints_.distribute_local_to_global(element, dofs, matrix_);
      return;
    }
    order_.resize(dofs.size());
    std::iota(order_.begin(), order_.end(), 0U);
    std::ranges::sort(order_, {}, [&](unsigned i) { return dofs[i]; });
    for (const unsigned i : order_) {
      int size = 0;
      double* value = nullptr;
      int* column = nullptr;
      matrix_.trilinos_matrix().ExtractMyRowView(int(dofs[i]), size, value, column);
      int entry = 0;
      for (const unsigned j : order_) {
        while (column[entry] != int(dofs[j])) ++entry;
        value[entry] += element(i, j);
      }
    }
  }

  void finish() { matrix_.compress(dealii::VectorOperation::add); }

 private:
  const dealii::AffineConstraints<double>& constraints_;
  SparseMatrix& matrix_;
  bool is_whole_;
  std::vector<unsigned> order_;  ///< of an element's unknowns, by their global numbers
};

void start_sums(LinearSystem& system) {
  system.force.compress(dealii::VectorOperation::add);  // what a failed assembly left behind
  system.force = 0.0;
  system.min_jacobian = 1.0;
  system.energy = 0.0;
}

void add_sums(const ElementSystem& element, LinearSystem& system) {
  system.min_jacobian = std::min(system.min_jacobian, element.min_jacobian);
  system.energy += element.energy;
}

void finish_sums(MPI_Comm communicator, LinearSystem& system) {
  system.force.compress(dealii::VectorOperation::add);
  system.min_jacobian = dealii::Utilities::MPI::min(system.min_jacobian, communicator);
  system.energy = dealii::Utilities::MPI::sum(system.energy, communicator);
}

}  // namespace

template <int dim>
LinearSystem::LinearSystem(const Body<dim>& body, bool with_coarse_matrix)
    : matrix(body.fine.matrix()), force(body.fine.vector()) {
  if (with_coarse_matrix) coarse_matrix.reinit(body.coarse.matrix());
}

template <int dim>
void for_each_element(const Body<dim>& body, ElementKernel<dim>& kernel, const Vector& displacement,
                      const ElementAction<dim>& take, Parts parts) {
  const std::vector<Eigen::Index> order = element_order(body.fine.element);
  const Vector u = body.fine.ghosted(displacement);
  using Owned = dealii::FilteredIterator<CellIterator<dim>>;
  const auto integrate = [&](const Owned& cell, Work<dim>& work, Contribution<dim>& result) {
    result.cell = static_cast<const CellIterator<dim>&>(cell);
    result.failure.clear();
    work.values.reinit(
        static_cast<typename dealii::Triangulation<dim>::cell_iterator>(result.cell));
    cell->get_dof_indices(work.indices);
    for (unsigned i = 0; i < order.size(); ++i) work.local[order[i]] = u[work.indices[i]];
    ElementSystem& element = result.element;
    try {
      refuse_crossed_sides(work.values);
      work.kernel->integrate(work.values, work.local, parts, element);
    } catch (const meshes::NotConverged& error) {
      result.failure = error.what();
      return;
    } catch (const std::domain_error& error) {  // of the material law, at the edge of J = 0
      result.failure = error.what();
      return;
    }
    for (unsigned i = 0; i < order.size(); ++i) {
      result.force[i] = element.force[order[i]];
      if (parts != Parts::all) continue;
      for (unsigned j = 0; j < order.size(); ++j)
        result.matrix(i, j) = element.matrix(order[i], order[j]);
    }
  };
  std::string failure;
  const auto hand_over = [&](const Contribution<dim>& result) {
    if (failure.empty()) failure = result.failure;
    if (failure.empty()) take(result.cell, result.matrix, result.force, result.element);
  };
  const dealii::IteratorFilters::LocallyOwnedCell owned;
  const meshes::OneBlasThread one_blas_thread;
  dealii::WorkStream::run(Owned(owned).set_to_next_positive(body.fine.dofs.begin_active()),
                          Owned(owned, body.fine.dofs.end()), integrate, hand_over,
                          Work<dim>(body, kernel), Contribution<dim>(order.size()));
  agree(failure, body.fine.communicator);
}

template <int dim>
void assemble(const Body<dim>& body, ElementKernel<dim>& kernel, const Vector& displacement,
              LinearSystem& system) {
  MatrixSum sum(body.fine.constraints, system.matrix);
  std::optional<MatrixSum> coarse_sum;
  if (system.coarse_matrix.m() > 0)
    coarse_sum.emplace(body.coarse.constraints, system.coarse_matrix);
  dealii::FullMatrix<double> embedding(body.fine.element.n_dofs_per_cell(),
                                       body.coarse.element.n_dofs_per_cell());
  dealii::FETools::get_interpolation_matrix(body.coarse.element, body.fine.element, embedding);
  // Nearly empty: each unknown is made of those of its own direction at the corners around it.
  using Dense = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::SparseMatrix<double> sparse =
      Eigen::Map<const Dense>(&embedding(0, 0), embedding.m(), embedding.n()).sparseView();
  dealii::FullMatrix<double> restricted(embedding.n(), embedding.n());
  std::vector<global_dof_index> fine(embedding.m()), coarse(embedding.n());
  start_sums(system);
  for_each_element(body, kernel, displacement,
                   [&](const CellIterator<dim>& cell, const dealii::FullMatrix<double>& matrix,
                       const dealii::Vector<double>& force, const ElementSystem& element) {
                     add_sums(element, system);
                     cell->get_dof_indices(fine);
                     body.fine.constraints.distribute_local_to_global(force, fine, system.force);
                     sum.add(matrix, fine);
                     if (!coarse_sum) return;
                     Eigen::Map<Dense>(&restricted(0, 0), sparse.cols(), sparse.cols()) =
                         sparse.transpose() *
                         (Eigen::Map<const Dense>(&matrix(0, 0), matrix.m(), matrix.n()) * sparse);
                     const CellIterator<dim> other(&body.triangulation, cell->level(),
                                                   cell->index(), &body.coarse.dofs);
                     other->get_dof_indices(coarse);
                     coarse_sum->add(restricted, coarse);
                   });
  sum.finish();
  if (coarse_sum) coarse_sum->finish();
  finish_sums(body.fine.communicator, system);
}

template <int dim>
void assemble_force(const Body<dim>& body, ElementKernel<dim>& kernel, const Vector& displacement,
                    LinearSystem& system) {
  start_sums(system);
  std::vector<global_dof_index> indices(body.fine.element.n_dofs_per_cell());
  for_each_element(
      body, kernel, displacement,
      [&](const CellIterator<dim>& cell, const dealii::FullMatrix<double>&,
          const dealii::Vector<double>& force, const ElementSystem& element) {
        add_sums(element, system);
        cell->get_dof_indices(indices);
        body.fine.constraints.distribute_local_to_global(force, indices, system.force);
      },
      Parts::force);
  finish_sums(body.fine.communicator, system);
}

template <int dim>
Vector condensed_force(const Body<dim>& body, ElementKernel<dim>& kernel,
                       const Vector& displacement,
                       const dealii::AffineConstraints<double>& constraints) {
  Vector result = body.fine.vector();
  std::vector<global_dof_index> indices(body.fine.element.n_dofs_per_cell());
  for_each_element(
      body, kernel, displacement,
      [&](const CellIterator<dim>& cell, const dealii::FullMatrix<double>&,
          const dealii::Vector<double>& force, const ElementSystem&) {
        cell->get_dof_indices(indices);
        constraints.distribute_local_to_global(force, indices, result);
      },
      Parts::force);
  result.compress(dealii::VectorOperation::add);
  return result;
}

template <int dim>
Vector unconstrained_force(const Body<dim>& body, ElementKernel<dim>& kernel,
                           const Vector& displacement) {
  return condensed_force(body, kernel, displacement, body.fine.hanging_nodes());
}

#define FINGERTIP_INSTANTIATE(dim)                                                             \
  template LinearSystem::LinearSystem(const Body<dim>&, bool);                                 \
  template void for_each_element(const Body<dim>&, ElementKernel<dim>&, const Vector&,         \
                                 const ElementAction<dim>&, Parts);                            \
  template void assemble(const Body<dim>&, ElementKernel<dim>&, const Vector&, LinearSystem&); \
  template void assemble_force(const Body<dim>&, ElementKernel<dim>&, const Vector&,           \
                               LinearSystem&);                                                 \
  template Vector condensed_force(const Body<dim>&, ElementKernel<dim>&, const Vector&,        \
                                  const dealii::AffineConstraints<double>&);                   \
  template Vector unconstrained_force(const Body<dim>&, ElementKernel<dim>&, const Vector&);
FINGERTIP_INSTANTIATE(2)
FINGERTIP_INSTANTIATE(3)
#undef FINGERTIP_INSTANTIATE

}  // namespace fingertip::fem_reference::inline elements
