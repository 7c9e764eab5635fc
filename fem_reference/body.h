/// deal.II's side of the continuum: an elastic body on a distributed mesh. Included by the sources
/// that use deal.II and by nobody else.
#pragma once

#include <deal.II/base/index_set.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_vector.h>

#include <string>
#include <vector>

#include "meshes/geometry.h"

namespace fingertip::fem_reference {

inline constexpr int dim = 3;
using Triangulation = dealii::parallel::distributed::Triangulation<dim>;
using Vector = dealii::TrilinosWrappers::MPI::Vector;
using SparseMatrix = dealii::TrilinosWrappers::SparseMatrix;
using CellIterator = dealii::DoFHandler<dim>::active_cell_iterator;

/// A displacement component (0, 1, 2) that a boundary holds at zero.
struct FixedComponent {
  dealii::types::boundary_id boundary = 0;
  int component = 0;
};

/// The displacement unknowns of one polynomial degree on a mesh: Lagrange hexahedra with nodes at
/// Gauss-Lobatto points, three unknowns a node.
struct Space {
  Space(const Triangulation& triangulation, int degree);

  /// Numbers the unknowns of the present mesh and collects what is not free: hanging nodes and
  /// fixed components.
  void number(const std::vector<FixedComponent>& fixed);

  /// An empty matrix for this space; rows and columns of constrained unknowns hold a diagonal.
  SparseMatrix matrix() const;
  Vector vector() const { return Vector(owned, communicator); }
  /// A copy that knows the neighbours' entries, with constrained unknowns filled in.
  Vector ghosted(const Vector& owned_values) const;

  /// Entries of some unknowns, in their order, on every process.
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
class Body {
 public:
  /// An empty mesh; fill `triangulation`, then call `number`. `degree` is 1, 2 or 3.
  Body(MPI_Comm communicator, int degree);

  void number(const std::vector<FixedComponent>& fixed);

  int degree() const { return int(fine.element.degree); }
  dealii::types::global_dof_index unknowns() const { return fine.dofs.n_dofs(); }

  Triangulation triangulation;
  /// Of the element's degree, so that linear displacements are reproduced exactly on curved
  /// elements, and with the manifolds the surface's error falls as fast as the displacement's.
  dealii::MappingQ<dim> mapping;
  Space fine, coarse;
};

/// Volume of the body [m³] and area of one boundary [m²], of the curved mesh by Gauss quadrature.
double volume(const Body& body);
double area(const Body& body, dealii::types::boundary_id boundary);

/// Sum of nodal forces (owned entries) over the nodes of one boundary [N], on every process.
meshes::Vector3 resultant(const Body& body, const Vector& forces,
                          dealii::types::boundary_id boundary);

}  // namespace fingertip::fem_reference
