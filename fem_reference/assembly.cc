#include "fem_reference/assembly.h"

#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe_tools.h>

#include <algorithm>
#include <stdexcept>

#include "meshes/errors.h"

namespace fingertip::fem_reference {
namespace {

using dealii::types::global_dof_index;

/// Position of every local unknown in the element's order dim a + i.
template <int dim>
std::vector<Eigen::Index> element_order(const dealii::FESystem<dim>& element) {
  std::vector<Eigen::Index> order(element.n_dofs_per_cell());
  for (unsigned i = 0; i < order.size(); ++i) {
    const auto [component, node] = element.system_to_component_index(i);
    order[i] = Eigen::Index(dim * node + component);
  }
  return order;
}

/// A failure on one process must be a failure on all, or the others would wait for ever.
void agree(const std::string& failure, MPI_Comm communicator) {
  const auto all = dealii::Utilities::MPI::all_gather(communicator, failure);
  const auto first = std::ranges::find_if(all, [](const std::string& s) { return !s.empty(); });
  if (first != all.end()) throw meshes::NotConverged(*first);
}

}  // namespace

template <int dim>
LinearSystem::LinearSystem(const Body<dim>& body, bool with_coarse_matrix)
    : matrix(body.fine.matrix()), force(body.fine.vector()) {
  if (with_coarse_matrix) coarse_matrix.reinit(body.coarse.matrix());
}

template <int dim>
void for_each_element(const Body<dim>& body, ElementKernel<dim>& kernel, const Vector& displacement,
                      const ElementAction<dim>& take) {
  const dealii::FiniteElement<dim>& scalar = body.fine.element.base_element(0);
  dealii::FEValues<dim> values(body.mapping, scalar, dealii::QGauss<dim>(scalar.degree + 1),
                               dealii::update_values | dealii::update_gradients |
                                   dealii::update_quadrature_points | dealii::update_JxW_values);
  const std::vector<Eigen::Index> order = element_order(body.fine.element);
  const Vector u = body.fine.ghosted(displacement);
  std::vector<global_dof_index> indices(order.size());
  Eigen::VectorXd local(Eigen::Index(order.size()));
  dealii::FullMatrix<double> matrix(unsigned(order.size()), unsigned(order.size()));
  dealii::Vector<double> force(static_cast<unsigned>(order.size()));
  ElementSystem element;
  std::string failure;
  for (const auto& cell : body.fine.dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned() || !failure.empty()) continue;
    values.reinit(static_cast<typename dealii::Triangulation<dim>::cell_iterator>(cell));
    cell->get_dof_indices(indices);
    for (unsigned i = 0; i < order.size(); ++i) local[order[i]] = u[indices[i]];
    try {
      kernel.integrate(values, local, element);
    } catch (const meshes::NotConverged& error) {
      failure = error.what();
      continue;
    } catch (const std::domain_error& error) {  // of the material law, at the edge of J = 0
      failure = error.what();
      continue;
    }
    for (unsigned i = 0; i < order.size(); ++i) {
      for (unsigned j = 0; j < order.size(); ++j) matrix(i, j) = element.matrix(order[i], order[j]);
      force[i] = element.force[order[i]];
    }
    take(cell, matrix, force, element);
  }
  agree(failure, body.fine.communicator);
}

template <int dim>
void assemble(const Body<dim>& body, ElementKernel<dim>& kernel, const Vector& displacement,
              LinearSystem& system) {
  system.matrix = 0.0;
  system.force.compress(dealii::VectorOperation::add);  // what a failed assembly left behind
  system.force = 0.0;
  const bool with_coarse = system.coarse_matrix.m() > 0;
  if (with_coarse) system.coarse_matrix = 0.0;
  dealii::FullMatrix<double> embedding(body.fine.element.n_dofs_per_cell(),
                                       body.coarse.element.n_dofs_per_cell());
  dealii::FETools::get_interpolation_matrix(body.coarse.element, body.fine.element, embedding);
  dealii::FullMatrix<double> restricted(embedding.n(), embedding.n());
  std::vector<global_dof_index> fine(embedding.m()), coarse(embedding.n());
  system.min_jacobian = 1.0;
  system.energy = 0.0;
  for_each_element(body, kernel, displacement,
                   [&](const CellIterator<dim>& cell, const dealii::FullMatrix<double>& matrix,
                       const dealii::Vector<double>& force, const ElementSystem& element) {
                     system.min_jacobian = std::min(system.min_jacobian, element.min_jacobian);
                     system.energy += element.energy;
                     cell->get_dof_indices(fine);
                     body.fine.constraints.distribute_local_to_global(matrix, force, fine,
                                                                      system.matrix, system.force);
                     if (!with_coarse) return;
                     restricted.triple_product(matrix, embedding, embedding, true, false);
                     const CellIterator<dim> other(&body.triangulation, cell->level(),
                                                   cell->index(), &body.coarse.dofs);
                     other->get_dof_indices(coarse);
                     body.coarse.constraints.distribute_local_to_global(restricted, coarse,
                                                                        system.coarse_matrix);
                     restricted = 0.0;
                   });
  system.matrix.compress(dealii::VectorOperation::add);
  system.force.compress(dealii::VectorOperation::add);
  if (with_coarse) system.coarse_matrix.compress(dealii::VectorOperation::add);
  system.min_jacobian = dealii::Utilities::MPI::min(system.min_jacobian, body.fine.communicator);
  system.energy = dealii::Utilities::MPI::sum(system.energy, body.fine.communicator);
}

template <int dim>
Vector condensed_force(const Body<dim>& body, ElementKernel<dim>& kernel,
                       const Vector& displacement,
                       const dealii::AffineConstraints<double>& constraints) {
  Vector result = body.fine.vector();
  std::vector<global_dof_index> indices(body.fine.element.n_dofs_per_cell());
  for_each_element(body, kernel, displacement,
                   [&](const CellIterator<dim>& cell, const dealii::FullMatrix<double>&,
                       const dealii::Vector<double>& force, const ElementSystem&) {
                     cell->get_dof_indices(indices);
                     constraints.distribute_local_to_global(force, indices, result);
                   });
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
                                 const ElementAction<dim>&);                                   \
  template void assemble(const Body<dim>&, ElementKernel<dim>&, const Vector&, LinearSystem&); \
  template Vector condensed_force(const Body<dim>&, ElementKernel<dim>&, const Vector&,        \
                                  const dealii::AffineConstraints<double>&);                   \
  template Vector unconstrained_force(const Body<dim>&, ElementKernel<dim>&, const Vector&);
FINGERTIP_INSTANTIATE(2)
FINGERTIP_INSTANTIATE(3)
#undef FINGERTIP_INSTANTIATE

}  // namespace fingertip::fem_reference
