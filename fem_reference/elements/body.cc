#include "fem_reference/elements/body.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparsity_tools.h>

#include "fem_reference/elements/kinematics.h"

namespace fingertip::fem_reference::inline elements {

template <int dim>
Space<dim>::Space(const Triangulation<dim>& triangulation, int degree, int components)
    : communicator(triangulation.get_communicator()),
      element(dealii::FE_Q<dim>(unsigned(degree)), unsigned(components)),
      dofs(triangulation) {}

template <int dim>
void Space<dim>::number(const std::vector<FixedComponent>& fixed) {
  dofs.distribute_dofs(element);
  owned = dofs.locally_owned_dofs();
  dealii::DoFTools::extract_locally_relevant_dofs(dofs, relevant);
  constraints.clear();
  constraints.reinit(relevant);
  dealii::DoFTools::make_hanging_node_constraints(dofs, constraints);
  for (const FixedComponent& entry : fixed) {
    std::vector<bool> component(element.n_components(), false);
    component[std::size_t(entry.component)] = true;
    dealii::DoFTools::make_zero_boundary_constraints(dofs, entry.boundary, constraints,
                                                     dealii::ComponentMask(component));
  }
  constraints.close();
}

template <int dim>
SparseMatrix Space<dim>::matrix() const {
  dealii::DynamicSparsityPattern pattern(relevant);
  dealii::DoFTools::make_sparsity_pattern(dofs, pattern, constraints, false);
  dealii::SparsityTools::distribute_sparsity_pattern(pattern, owned, communicator, relevant);
  SparseMatrix result;
  result.reinit(owned, owned, pattern, communicator);
  return result;
}

template <int dim>
dealii::AffineConstraints<double> Space<dim>::hanging_nodes() const {
  dealii::AffineConstraints<double> result(relevant);
  dealii::DoFTools::make_hanging_node_constraints(dofs, result);
  result.close();
  return result;
}

template <int dim>
Vector Space<dim>::ghosted(const Vector& owned_values) const {
  Vector complete = owned_values;
  constraints.distribute(complete);
  Vector result(owned, relevant, communicator);
  result = complete;
  return result;
}

template <int dim>
std::vector<double> Space<dim>::gather(const Vector& owned_values,
                                       const std::vector<long>& unknowns) const {
  std::vector<double> own(unknowns.size(), 0.0), all(own);
  for (std::size_t i = 0; i < own.size(); ++i)
    if (unknowns[i] >= 0 && owned.is_element(unsigned(unknowns[i])))
      own[i] = owned_values[unsigned(unknowns[i])];
  dealii::Utilities::MPI::sum(own, communicator, all);
  return all;
}

template <int dim>
Body<dim>::Body(MPI_Comm communicator, int degree, int components)
    : triangulation(communicator),
      mapping(unsigned(degree)),
      fine(triangulation, degree, components),
      coarse(triangulation, 1, components) {}

template <int dim>
void Body<dim>::number(const std::vector<FixedComponent>& fixed) {
  mapping.initialize(dealii::MappingQ<dim>(unsigned(degree())), triangulation);
  fine.number(fixed);
  coarse.number(fixed);
}

template <int dim>
double volume(const Body<dim>& body) {
  dealii::FEValues<dim> values(body.mapping, body.fine.element,
                               dealii::QGauss<dim>(unsigned(body.degree()) + 2),
                               dealii::update_JxW_values | dealii::update_quadrature_points);
  double sum = 0.0;
  for (const auto& cell : body.fine.dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    values.reinit(cell);
    for (const unsigned q : values.quadrature_point_indices()) sum += weight(values, q);
  }
  return dealii::Utilities::MPI::sum(sum, body.fine.communicator);
}

template <int dim>
double area(const Body<dim>& body, dealii::types::boundary_id boundary) {
  dealii::FEFaceValues<dim> values(body.mapping, body.fine.element,
                                   dealii::QGauss<dim - 1>(unsigned(body.degree()) + 2),
                                   dealii::update_JxW_values | dealii::update_quadrature_points);
  double sum = 0.0;
  for (const auto& cell : body.fine.dofs.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    for (const auto& face : cell->face_iterators()) {
      if (!face->at_boundary() || face->boundary_id() != boundary) continue;
      values.reinit(cell, face);
      for (const unsigned q : values.quadrature_point_indices()) sum += weight(values, q);
    }
  }
  return dealii::Utilities::MPI::sum(sum, body.fine.communicator);
}

template <int dim>
meshes::Vector3 resultant(const Body<dim>& body, const Vector& forces,
                          dealii::types::boundary_id boundary) {
  meshes::Vector3 sum = meshes::Vector3::Zero();
  for (unsigned c = Kinematics<dim>::revolved ? 1 : 0; c < dim; ++c) {
    dealii::ComponentMask component(unsigned(body.components()), false);
    component.set(c, true);
    double& along = sum[Kinematics<dim>::axis[c]];
    for (const auto i :
         dealii::DoFTools::extract_boundary_dofs(body.fine.dofs, component, {boundary}))
      if (body.fine.owned.is_element(i)) along += forces[i];
    along = dealii::Utilities::MPI::sum(along, body.fine.communicator);
  }
  return sum;
}

template struct Space<2>;
template struct Space<3>;
template class Body<2>;
template class Body<3>;
template double volume(const Body<2>&);
template double volume(const Body<3>&);
template double area(const Body<2>&, dealii::types::boundary_id);
template double area(const Body<3>&, dealii::types::boundary_id);
template meshes::Vector3 resultant(const Body<2>&, const Vector&, dealii::types::boundary_id);
template meshes::Vector3 resultant(const Body<3>&, const Vector&, dealii::types::boundary_id);

}  // namespace fingertip::fem_reference::inline elements
