/// deal.II's side of the continuum: an elastic body on a distributed mesh. Included by the sources
/// that use deal.II and by nobody else.
///
/// `dim` is 3 for a solid, 2 for a body of revolution that deforms without leaving its symmetry: a
/// mesh of its meridian in (r, z), displacements (u_r, u_z) or, where it is twisted, (u_r, u_z,
/// u_phi); see kinematics.h.
#pragma once

#include <deal.II/base/index_set.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q_cache.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_vector.h>

#include <string>
#include <vector>

#include "meshes/shape/geometry.h"

namespace fingertip::fem_reference::inline elements {

template <int dim>
using Triangulation = dealii::parallel::distributed::Triangulation<dim>;
template <int dim>
using CellIterator = typename dealii::DoFHandler<dim>::active_cell_iterator;
using Vector = dealii::TrilinosWrappers::MPI::Vector;
using SparseMatrix = dealii::TrilinosWrappers::SparseMatrix;

/// A displacement component that a boundary holds at zero.
struct FixedComponent {
  dealii::types::boundary_id boundary = 0;
  int component = 0;
};

/// The displacement unknowns of one polynomial degree on a mesh: Lagrange elements with nodes at
/// Gauss-Lobatto points, `components` unknowns a node.
template <int dim>
struct Space {
  Space(const Triangulation<dim>& triangulation, int degree, int components = dim);

  /// Numbers the unknowns of the present mesh and collects what is not free: hanging nodes and
  /// fixed components.
  void number(const std::vector<FixedComponent>& fixed);

  /// An empty matrix for this space; rows and columns of constrained unknowns hold a diagonal.
  SparseMatrix matrix() const;
  Vector vector() const { return Vector(owned, communicator); }
  /// A copy that knows the neighbours' entries, with constrained unknowns filled in.
  Vector ghosted(const Vector& owned_values) const;

  /// Entries of some unknowns, in their order, on every process; 0 where there is none (-1).
  std::vector<double> gather(const Vector& owned_values, const std::vector<long>& unknowns) const;

  /// What ties hanging nodes to the nodes they follow, without anything that holds the body.
  dealii::AffineConstraints<double> hanging_nodes() const;

  MPI_Comm communicator;
  dealii::FESystem<dim> element;
  dealii::DoFHandler<dim> dofs;
  dealii::IndexSet owned, relevant;
  dealii::AffineConstraints<double> constraints;
};

/// A mesh with two spaces: `fine`, in which the solution is sought, and `coarse`, linear elements
/// on the same mesh, from which multigrid starts.
template <int dim>
class Body {
 public:
  /// An empty mesh; fill `triangulation`, then call `number`, and again when it has changed.
  /// `degree` is 1, 2 or 3; `components` is dim, or 3 of a body of revolution that is twisted.
  Body(MPI_Comm communicator, int degree, int components = dim);

  void number(const std::vector<FixedComponent>& fixed);

  int degree() const { return int(fine.element.degree); }
  int components() const { return int(fine.element.n_components()); }
  dealii::types::global_dof_index unknowns() const { return fine.dofs.n_dofs(); }

  Triangulation<dim> triangulation;
  /// Of the element's degree, so that linear displacements are reproduced exactly on curved
  /// elements, and with the manifolds the surface's error falls as fast as the displacement's.
  /// Its points are found by `number`, once for a mesh: on surfaces of CAD parts they are dear.
  dealii::MappingQCache<dim> mapping;
  Space<dim> fine, coarse;
};

/// Volume of the body [m³] and area of one boundary [m²], of the curved mesh by Gauss quadrature.
template <int dim>
double volume(const Body<dim>& body);
template <int dim>
double area(const Body<dim>& body, dealii::types::boundary_id boundary);

/// Sum of nodal forces (owned entries) over the nodes of one boundary [N], on every process. Of a
/// body of revolution only the part along the axis means anything; the others are zero.
template <int dim>
meshes::Vector3 resultant(const Body<dim>& body, const Vector& forces,
                          dealii::types::boundary_id boundary);

}  // namespace fingertip::fem_reference::inline elements
